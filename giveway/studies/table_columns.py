"""The columns of the tables of means and differences; those of the factors come before them."""

from giveway.run_data.columns import Column


def numbers_of(columns: tuple[Column, ...]) -> list[str]:
    """Return the names of the columns with numbers that need not be whole."""
    return [column.name for column in columns if column.type == "number"]


_COMPARED = (
    Column("ego", "string", None, "SUMO id of the ego; empty: the run has none"),
    Column("treatment", "string", None, "the level that is compared"),
    Column("baseline", "string", None, "the level that is subtracted"),
)
_SITUATION = Column("situation", "string", None, "general, stop-and-wait, non-stop or slowed")
_METRIC = (
    Column("metric", "string", None, "the summary's column whose difference this is"),
    Column("unit", "string", None, "of the means, the differences and the interval"),
)

COMPARISON_COLUMNS = (
    *_COMPARED,
    _SITUATION,
    *_METRIC,
    Column("n", "integer", None, "pairs in the situation with a number on both sides"),
    Column("share", "number", None, "of the situation among the pairs that are not lost"),
    Column("treatment_mean", "number", None, "mean over the treatment's side of the n pairs"),
    Column("baseline_mean", "number", None, "mean over the baseline's side of the n pairs"),
    Column("mean_difference", "number", None, "mean of treatment minus baseline, pair by pair"),
    Column("ci_low", "number", None, "lower end of the mean difference's interval"),
    Column("ci_high", "number", None, "upper end of the mean difference's interval"),
    Column("median_difference", "number", None, "median of treatment minus baseline"),
    Column("wilcoxon_statistic", "number", None, "smaller one of the two signed-rank sums"),
    Column("p_value", "number", None, "of the two-sided Wilcoxon signed-rank test"),
    Column("q_value", "number", None, "p_value after Benjamini and Hochberg, within the study"),
    Column("verdict", "string", None, "better, worse, no difference shown, or N.A."),
    Column("interval", "string", None, "how it was made: BCa, percentile, constant; empty: N.A."),
)

SITUATION_COLUMNS = (
    *_COMPARED,
    Column("pairs", "integer", None, "seeds that both levels were run with"),
    Column("share_both_stop", "number", None, "of the pairs that are not lost"),
    Column("share_neither_stops", "number", None, "of the pairs that are not lost"),
    Column("share_only_treatment_stops", "number", None, "of the pairs that are not lost"),
    Column("share_only_baseline_stops", "number", None, "of the pairs that are not lost"),
    Column("lost", "integer", None, "pairs of which a side failed or crashed"),
    Column("incomplete", "integer", None, "pairs, not lost, of which a side missed its goal"),
)

LEVEL_COLUMNS = (
    Column("ego", "string", None, "SUMO id of the ego; empty: the run has none"),
    Column("metric", "string", None, "the summary's column whose mean this is"),
    Column("unit", "string", None, "of the mean, the interval and the extremes"),
    Column("runs", "integer", None, "runs of the cell with a result"),
    Column("n", "integer", None, "of these with a number in this metric"),
    Column("mean", "number", None, "mean of the n numbers"),
    Column("ci_low", "number", None, "lower end of the mean's interval"),
    Column("ci_high", "number", None, "upper end of the mean's interval"),
    Column("smallest", "number", None, "of the n numbers"),
    Column("largest", "number", None, "of the n numbers"),
    Column("interval", "string", None, "how it was made: BCa, percentile, constant; empty: none"),
    Column("share_slowed", "number", None, "of the runs, in which people ever slowed the ego"),
    Column("slowed_n", "integer", None, "of these runs with a number in this metric"),
    Column("slowed_mean", "number", None, "mean of the numbers of these runs alone"),
    Column("slowed_ci_low", "number", None, "lower end of that mean's interval"),
    Column("slowed_ci_high", "number", None, "upper end of that mean's interval"),
)

FRONT_COLUMNS = (
    Column("ego", "string", None, "SUMO id of the ego"),
    Column("runs", "integer", None, "runs of the cell with a result"),
    Column("arrived", "integer", None, "of these, whose ego reached its goal"),
    Column("ego_time", "number", "s", "mean time to the goal of those that arrived"),
    Column("ego_time_low", "number", "s", "lower end of its interval; empty: too few runs"),
    Column("ego_time_high", "number", "s", "upper end of its interval"),
    Column("people_delay", "number", "s", "mean over the runs of the people's mean delay"),
    Column("people_delay_low", "number", "s", "lower end of its interval; empty: too few runs"),
    Column("people_delay_high", "number", "s", "upper end of its interval"),
    Column("front", "boolean", None, "no other level of the context is better on both sides"),
)

PRECISION_COLUMNS = (
    *_COMPARED,
    _SITUATION,
    *_METRIC,
    Column("seeds", "integer", None, "of each cell, the first ones, that were looked at"),
    Column("n", "integer", None, "pairs in the situation with a number on both sides"),
    Column("mean_difference", "number", None, "mean of treatment minus baseline, pair by pair"),
    Column("ci_low", "number", None, "lower end of its interval"),
    Column("ci_high", "number", None, "upper end of its interval"),
    Column("width", "number", None, "of the interval"),
    Column("wanted", "number", None, "width below which it is narrow enough"),
    Column("precise", "boolean", None, "whether it is"),
)

TABLE_2_COLUMNS = (
    Column("ego", "string", None, "SUMO id of the ego"),
    Column("pedestrians", "integer", "persons", "of the crowd"),
    _SITUATION,
    *_METRIC,
    Column("published", "number", "s", "Yang & Özgüner 2019, Table 2; empty: N.A."),
    Column("mean_difference", "number", "s", "ours, MPC minus PID; empty: N.A. or not run"),
    Column("ci_low", "number", "s", "lower end of our interval"),
    Column("ci_high", "number", "s", "upper end of our interval"),
    Column("n", "integer", None, "our pairs in the situation"),
    Column("share", "number", None, "of the situation among the pairs that are not lost"),
    Column("verdict", "string", None, "better, worse, no difference shown, or N.A."),
    Column("agreement", "string", None, "inside, below, above our interval; empty: no number"),
)
