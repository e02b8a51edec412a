"""The model description as XML: no document types, no monsters."""

from __future__ import annotations

import pytest

from fmus.archive.archive_check import open_archive
from fmus.errors import FmuArchiveError, FmuFileError

DESCRIPTION = b'<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0"/>'
MEGABYTE = 1 << 20


# ---- the model description as XML ----

OPEN, CLOSE = b"<fmiModelDescription>", b"</fmiModelDescription>"
LAUGHS = b"""<?xml version="1.0"?><!DOCTYPE lolz [<!ENTITY lol "lol">
<!ENTITY lol2 "&lol;&lol;&lol;&lol;&lol;&lol;&lol;&lol;&lol;&lol;">
<!ENTITY lol3 "&lol2;&lol2;&lol2;&lol2;&lol2;&lol2;&lol2;&lol2;&lol2;&lol2;">]>
<fmiModelDescription modelName="&lol3;"/>"""
XXE = (
    b'<?xml version="1.0"?><!DOCTYPE d [<!ENTITY x SYSTEM "file:///etc/passwd">]>'
    b'<fmiModelDescription modelName="&x;"/>'
)


@pytest.mark.parametrize("xml", [LAUGHS, XXE, b"<!DOCTYPE html><html/>"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_a_document_type_is_refused_at_sight(archive, xml, encoding, refused):
    text = xml.decode().replace("?>", f' encoding="{encoding.removesuffix("-sig")}"?>', 1)
    path = archive(description=text.encode(encoding))
    with refused(FmuArchiveError, path, "modelDescription.xml, line 1", "DOCTYPE"):
        open_archive(path)


@pytest.mark.parametrize(
    "xml",
    [
        b"",
        b"not XML",
        b"<fmiModelDescription>",
        b"<fmiModelDescription/><second/>",
        b'<fmiModelDescription a="1" a="2"/>',
        b'<fmiModelDescription modelName="&unknown;"/>',
        b'<fmiModelDescription modelName="\x00"/>',
        b'<fmiModelDescription modelName="\xff"/>',
        b'<?xml version="1.0" encoding="no-such-encoding"?><fmiModelDescription/>',
    ],
)
def test_a_model_description_that_is_no_xml(archive, xml, refused):
    path = archive(description=xml)
    with refused(FmuFileError, path, "modelDescription.xml", "export the model again"):
        open_archive(path)


def test_elements_within_elements_without_end(archive, refused):
    path = archive(description=OPEN + b"<a>" * 100_000)
    with refused(FmuArchiveError, path, "64 elements within each other"):
        open_archive(path)


def test_elements_without_number(archive, refused):
    path = archive(description=OPEN + b"<b/>" * 600_000 + CLOSE)
    with refused(FmuArchiveError, path, "600000 elements"):
        open_archive(path)


def test_attributes_without_number(archive, refused):
    attributes = b" ".join(b'a%d=""' % n for n in range(5000))
    path = archive(description=OPEN + b"<Unit " + attributes + b"/>" + CLOSE)
    with refused(FmuArchiveError, path, "5000 attributes"):
        open_archive(path)


def test_an_attribute_without_end(archive, refused):
    path = archive(description=OPEN + b'<Unit name="' + bytes(range(65, 91)) * 400_000)
    with refused(FmuArchiveError, path, "a tag of more than 4 MB"):
        open_archive(path)


def test_another_first_element(archive, refused):
    path = archive(description=b'<?xml version="1.0"?>\n<svg/>')
    with refused(FmuFileError, path, "line 2", "<svg>", "fmiModelDescription"):
        open_archive(path)


def test_what_an_fmu_says_cannot_steer_the_terminal(archive):
    path = archive(("resources/\N{RIGHT-TO-LEFT OVERRIDE}evil", b""))
    with pytest.raises(FmuArchiveError) as caught:
        open_archive(path)
    assert str(caught.value).isprintable()
