"""Code is imported from installed distributions, and from nowhere else."""

from __future__ import annotations

import json
import sys

import pytest

from giveway.errors import ControlError
from giveway.plug_ins.finding import declared_names, find, is_reference, load

DRIVER = "class Driver:\n    def control(self, seen):\n        return 0.0\n"


def test_an_entry_point_and_a_module_mean_the_same(installed):
    installed("own_driver", DRIVER, version="2.1", declares="ours = own_driver:Driver")
    declared, named = find("ours"), find("own_driver:Driver")
    assert (declared.distribution, declared.version) == ("own-driver", "2.1")
    assert declared.reference == named.reference == "own_driver:Driver"
    assert declared.sha256 == named.sha256
    assert load(declared) is load(named)
    assert "ours" in declared_names()


def test_finding_imports_nothing(installed):
    installed("loud_driver", "raise RuntimeError('imported')\n")
    find("loud_driver:Driver")
    assert "loud_driver" not in sys.modules


def test_the_hash_changes_with_the_content(installed):
    installed("own_driver", DRIVER)
    before = find("own_driver:Driver").sha256
    installed("own_driver", DRIVER + "# other\n")
    assert find("own_driver:Driver").sha256 != before


def test_a_file_in_the_working_folder_is_not_imported(tmp_path, monkeypatch):
    here = tmp_path / "here"
    here.mkdir()
    (here / "stray_driver.py").write_text("raise SystemExit('imported')\n", encoding="utf-8")
    monkeypatch.chdir(here)
    monkeypatch.syspath_prepend("")
    with pytest.raises(ControlError, match="no installed package has the module 'stray_driver'"):
        find("stray_driver:Driver")
    assert "stray_driver" not in sys.modules


def test_nor_is_it_in_the_way_of_an_installed_one(installed, tmp_path, monkeypatch):
    installed("own_driver", DRIVER)
    here = tmp_path / "here"
    here.mkdir()
    (here / "own_driver.py").write_text("raise SystemExit('imported')\n", encoding="utf-8")
    monkeypatch.chdir(here)
    monkeypatch.syspath_prepend("")
    assert load(find("own_driver:Driver")).__name__ == "Driver"


def test_a_module_on_the_path_that_is_not_installed_is_refused(tmp_path, monkeypatch):
    (tmp_path / "loose_driver.py").write_text("raise SystemExit('imported')\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(ControlError, match=r"loose_driver\.py is not installed"):
        find("loose_driver:Driver")


def test_a_project_installed_for_development_is_installed(tmp_path, monkeypatch):
    project, site = tmp_path / "my project", tmp_path / "site"
    project.mkdir()
    info = site / "dev_driver-0.1.dist-info"
    info.mkdir(parents=True)
    (project / "dev_driver.py").write_text(DRIVER, encoding="utf-8")
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: dev-driver\nVersion: 0.1\n")
    (info / "RECORD").write_text("_dev_driver.pth,,\n")
    direct = {"url": project.as_uri(), "dir_info": {"editable": True}}
    (info / "direct_url.json").write_text(json.dumps(direct))
    monkeypatch.syspath_prepend(str(site))
    monkeypatch.syspath_prepend(str(project))
    assert find("dev_driver:Driver").distribution == "dev-driver"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("raise ValueError('bad\\nday')\n", r"ValueError: bad day"),
        ("raise SystemExit(3)\n", r"SystemExit: 3"),
        ("import not_there_at_all\n", r"ModuleNotFoundError"),
        ("Other = 1\n", r"AttributeError"),
        ("class Driver:\n", r"IndentationError"),
    ],
)
def test_code_that_cannot_be_imported_is_told_on_one_line(installed, text, said):
    installed("own_driver", text)
    with pytest.raises(ControlError, match=said) as caught:
        load(find("own_driver:Driver"))
    assert "own-driver 1.0" in str(caught.value)
    assert str(caught.value).isprintable()


def test_two_packages_of_one_name_are_told_apart(installed):
    installed("one_driver", DRIVER, declares="same = one_driver:Driver")
    installed("two_driver", DRIVER, declares="same = two_driver:Driver")
    with pytest.raises(ControlError, match="one_driver:Driver and two_driver:Driver both"):
        find("same")


@pytest.mark.parametrize("name", ["mpc", "a.b", "a:", ":b", "a b:c", "../a:b", "a:b()", "a:b\n"])
def test_what_is_no_reference(name):
    assert not is_reference(name)
