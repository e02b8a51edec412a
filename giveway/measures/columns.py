"""The columns of ``measures.csv``."""

from giveway.run_data.columns import Column

MEASURE_COLUMNS = (
    Column("measure", "string", None, "name of the line or area"),
    Column("kind", "string", None, "line or area"),
    Column("begin", "number", "s", "simulation time at which the interval begins"),
    Column("end", "number", "s", "simulation time before which it ends"),
    Column("people", "number", "persons", "mean number in the area"),
    Column("classic_density", "number", "1/m^2", "mean number in the area over its size"),
    Column("density", "number", "1/m^2", "mean Voronoi density of the area"),
    Column("peak_density", "number", "1/m^2", "largest Voronoi density of the area"),
    Column(
        "speed", "number", "m/s", "mean speed of those in the area, or of those who cross the line"
    ),
    Column("crossings", "integer", "persons", "who cross the line, each for the first time"),
    Column("crossed", "integer", "persons", "the same since the run began (N-t)"),
    Column("flow", "number", "1/s", "crossings per time"),
    Column("specific_flow", "number", "1/(m s)", "flow over the line's length"),
    Column("service_fruin", "string", None, "level of service A to F by Fruin 1971"),
    Column("service_hcm", "string", None, "level of service A to F by the HCM 2000"),
)
