"""Keys and flags that no longer exist are refused with what to write instead."""

import pytest

from giveway.cli.program import main
from giveway.config.files.layers import Layer, build_config, options
from giveway.config.renamed import FLAGS, RENAMED, renamed_flag
from giveway.errors import ConfigError
from giveway.plug_ins.sockets import SOCKETS


def test_a_key_that_moved_is_refused_with_its_new_name():
    with pytest.raises(ConfigError) as refused:
        build_config([Layer("a.toml", {"mpc": {"force_limit": 9000.0}})])
    expected = "a.toml: [mpc] force_limit: no longer exists; write [vehicle] force_limit"
    assert str(refused.value) == expected


def test_a_key_that_moved_is_found_in_the_table_of_an_ego():
    with pytest.raises(ConfigError, match=r"write \[vehicle\] force_limit"):
        build_config([Layer("a.toml", {"egos": [{"mpc": {"force_limit": 9000.0}}]})])


def test_a_flag_that_moved_is_told_its_new_name():
    assert renamed_flag("--mpc-force-limit=9000") == "write --vehicle-force-limit"
    assert renamed_flag("--vehicle-force-limit") is None
    assert renamed_flag("--mpc-horizon") == "write --set horizon=VALUE"
    assert renamed_flag("--attitude") == renamed_flag("--planner-attitude") == "write --style"


def test_a_negative_flag_is_told_the_negative_one():
    assert renamed_flag("--no-obey-lights") == "write --no-rules-traffic-lights"
    assert renamed_flag("--no-crowd-detour") == "write --set-model detour=false"
    assert renamed_flag("--no-regulation-traffic-lights") == "write --no-rules-traffic-lights"


@pytest.mark.parametrize("flag", FLAGS)
def test_a_flag_that_is_gone_ends_the_command(flag, capsys):
    with pytest.raises(SystemExit) as caught:
        main(["run", "street", f"--{flag}"])
    assert caught.value.code == 2
    assert f"--{flag}: no longer exists; " in capsys.readouterr().err


@pytest.mark.parametrize("old", RENAMED)
def test_no_renamed_key_exists_and_each_new_one_does(old):
    known = {option.location for option in options()}
    new = RENAMED[old]
    assert old not in known
    own = not isinstance(new, str) and new[0] in {socket.options for socket in SOCKETS}
    assert isinstance(new, str) or own or new in known
    assert set(FLAGS.values()) <= set(RENAMED)
