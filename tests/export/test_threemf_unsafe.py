"""3MF files that are unsafe or not valid: refused with a clear message, most of them before lib3mf sees a byte."""

from __future__ import annotations

import io
import struct
import tracemalloc
import zipfile
import zlib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneutouch.errors import InputError
from pneutouch.export.threemf import threemf
from pneutouch.export.threemf_read import read_threemf
from tests.export.test_threemf import material, tetrahedron
from tests.export.threemf_files import MODEL, parts_of, with_model, write_parts

GOOD = threemf(
    "x", (tetrahedron(material()), tetrahedron(material(), "c", "connector", 9.0)), {"Title": "t"}, b"\x89PNG"
)

with zipfile.ZipFile(io.BytesIO(GOOD)) as _archive:
    PARTS = {name: _archive.read(name) for name in _archive.namelist()}


@pytest.fixture
def good(tmp_path):
    path = tmp_path / "good.3mf"
    path.write_bytes(GOOD)
    return path


def test_a_part_without_a_name_is_refused(tmp_path):
    path = tmp_path / "bad.3mf"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("xa", b"a")
    # A name ends at a zero byte.
    path.write_bytes(path.read_bytes().replace(b"xa", b"\0a"))
    with pytest.raises(InputError, match=r"bad\.3mf: a part without a name"):
        read_threemf(path)


DOCTYPE = '<!DOCTYPE model [<!ENTITY a "lol">]>'
EXTERNAL = '<!DOCTYPE model [<!ENTITY a SYSTEM "file:///etc/passwd">]>'
PARAMETER = '<!DOCTYPE model [<!ENTITY % p SYSTEM "http://example.org/x.dtd"> %p;]>'
BARE = '<!DOCTYPE model SYSTEM "http://example.org/x.dtd">'


def typed(doctype, encoding):
    def change(model):
        text = model.decode().split("?>", 1)[1]
        head = f'<?xml version="1.0" encoding="{encoding}"?>' if encoding else ""
        return (head + doctype + text).encode(encoding or "utf-8")

    return change


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le", "utf-16-be", "latin-1", "cp1252", None])
@pytest.mark.parametrize("doctype", [DOCTYPE, EXTERNAL, PARAMETER, BARE])
def test_document_types_and_entities_are_refused_in_every_encoding(tmp_path, good, doctype, encoding):
    path = with_model(good, tmp_path / "bad.3mf", typed(doctype, encoding))
    with pytest.raises(InputError, match=r"bad\.3mf: 3D/3dmodel\.model: (has a document type|not well-formed)"):
        read_threemf(path)


@pytest.mark.parametrize(
    "name", ["_rels/.rels", "[Content_Types].xml", "Metadata/thumbnail.png", "Metadata/notes.config"]
)
def test_they_are_refused_in_every_part_whatever_it_is_called(tmp_path, good, name):
    parts = parts_of(good)
    path = write_parts(
        tmp_path / "bad.3mf", {**parts, name: f"<?xml version='1.0'?>{EXTERNAL}<model/>".encode("utf-16")}
    )
    with pytest.raises(InputError, match="has a document type or entities"):
        read_threemf(path)


def test_a_doctype_that_is_only_text_is_none(tmp_path):
    path = tmp_path / "x.3mf"
    path.write_bytes(threemf("x", (tetrahedron(material()),), {"Title": DOCTYPE}))
    assert read_threemf(path).metadata["Title"] == DOCTYPE


def declared(size):
    """An archive whose model part claims to inflate to ``size`` bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, part in PARTS.items():
            archive.writestr(name, part)
    content = bytearray(buffer.getvalue())
    at = content.index(b"PK\x01\x02")
    content[at + 24 : at + 28] = struct.pack("<I", size)
    return bytes(content)


def bomb(size):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        archive.writestr(MODEL, bytes(size))
    return buffer.getvalue()


def many(count):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for k in range(count):
            archive.writestr(f"{k}", b"")
    return buffer.getvalue()


def repeated(*names):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name in names:
            archive.writestr(name, b"<model/>")
    return buffer.getvalue()


def packed(method):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        archive.writestr(MODEL, b"<model/>")
    return buffer.getvalue()


def encrypted():
    content = bytearray(packed(zipfile.ZIP_STORED))
    for head, flags in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        content[content.index(head) + flags] |= 1
    return bytes(content)


def flipped(at):
    content = bytearray(GOOD)
    content[at] ^= 0xFF
    return bytes(content)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize(
    ("content", "said"),
    [
        (lambda: b"", "not a zip archive"),
        (lambda: b"solid x\nendsolid x\n" * 99, "not a zip archive; a 3MF is a zip archive"),
        (lambda: GOOD[: len(GOOD) // 2], "a zip archive cut short or damaged"),
        (lambda: GOOD[:-1], "a zip archive cut short or damaged"),
        (lambda: GOOD[len(GOOD) // 2 :], "zip archive"),
        (lambda: flipped(GOOD.index(b"PK\x01\x02") // 2), "damaged zip archive"),
        (lambda: declared(2**31), "inflates to more than 256 MiB"),
        (lambda: declared(1000), "damaged zip archive (Bad CRC-32"),
        (lambda: declared(10**6), "bytes and not the 1000000 declared"),
        (lambda: bomb(2**28 + 1), "inflates to more than 256 MiB"),
        (lambda: many(1001), "more than 1000 parts"),
        (lambda: many(70000), "more than 1000 parts"),
        (lambda: repeated(MODEL, MODEL), "there twice"),
        (lambda: repeated(MODEL, MODEL.upper()), "there twice"),
        (lambda: packed(zipfile.ZIP_LZMA), "packed by a method"),
        (encrypted, "encrypted or packed by a method"),
        (lambda: many(1), "not a valid 3MF"),
        (lambda: repeated(MODEL), "not a valid 3MF"),
    ],
)
def test_archives_that_are_unsafe_or_damaged_are_refused(tmp_path, content, said):
    path = tmp_path / "bad.3mf"
    path.write_bytes(content())
    with pytest.raises(InputError) as error:
        read_threemf(path)
    assert str(error.value).startswith(f"{path}: ")
    assert said in str(error.value)
    assert list(tmp_path.iterdir()) == [path]


def lying(size):
    """An archive whose model inflates to 300 MB and declares ``size`` bytes, its check sum that of so many."""
    content = bytearray(bomb(300 * 2**20))
    for head, at in ((b"PK\x03\x04", 14), (b"PK\x01\x02", 16)):
        start = content.index(head) + at
        content[start : start + 4] = struct.pack("<I", zlib.crc32(bytes(size)))
        content[start + 8 : start + 12] = struct.pack("<I", size)
    return bytes(content)


def test_no_more_is_inflated_than_an_archive_declares(tmp_path):
    path = tmp_path / "bad.3mf"
    path.write_bytes(lying(1000))
    tracemalloc.start()
    with pytest.raises(InputError, match="not well-formed XML"):
        read_threemf(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 16 * 2**20


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (b"<triangle ", b"<triangle v9='1' ", "not a valid 3MF"),
        (b'v1="0"', b'v1="77"', "not a valid 3MF"),
        (b'unit="millimeter"', b'unit="cubit"', "not a valid 3MF"),
        (b'objectid="', b'objectid="9', "not a valid 3MF"),
        (b"</model>", b"", "not well-formed XML"),
        (b"<resources>", b"<resources>" + b"<a>" * 99 + b"</a>" * 99, "nested deeper than 64"),
        (b"<resources>", b"<resources>\xff\xfe", "not well-formed XML"),
    ],
)
def test_models_that_are_not_valid_are_refused(tmp_path, good, old, new, said):
    assert old in parts_of(good)[MODEL]
    path = with_model(good, tmp_path / "bad.3mf", lambda model: model.replace(old, new, 1))
    with pytest.raises(InputError, match=r"bad\.3mf") as error:
        read_threemf(path)
    assert said in str(error.value)


def test_paths_that_are_no_file_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"none\.3mf: no such file"):
        read_threemf(tmp_path / "none.3mf")
    with pytest.raises(InputError, match="this is a folder; give a 3MF file"):
        read_threemf(tmp_path)
    with pytest.raises(InputError, match="not a plain file"):
        read_threemf(type(tmp_path)("/dev/null"))
    large = tmp_path / "large.3mf"
    with large.open("wb") as file:
        file.truncate(2**28 + 1)
    with pytest.raises(InputError, match=r"large\.3mf: larger than 256 MiB"):
        read_threemf(large)


@settings(max_examples=150)
@given(data=st.data())
def test_bytes_changed_anywhere_are_read_or_refused_and_nothing_else(tmp_path_factory, data):
    parts = {**PARTS}
    name = data.draw(st.sampled_from([MODEL, MODEL, MODEL, *sorted(parts)]))
    content = bytearray(parts[name])
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content)))
        content[at : at + data.draw(st.integers(0, 20))] = data.draw(st.binary(max_size=20))
    path = write_parts(tmp_path_factory.mktemp("x") / "x.3mf", {**parts, name: bytes(content)})
    try:
        read_threemf(path)
    except InputError as error:
        assert str(error).startswith(f"{path}: ")


def chained(depth, width, last="2"):
    """Objects of ``width`` components each, every one the one before: ``width ** depth`` bodies in a few kB."""

    def change(model):
        text = model.decode()
        ends = text.index("</resources>")
        chain, child = "", last
        for k in range(depth):
            inside = f'<component objectid="{child}"/>' * width
            chain += f'<object id="{100 + k}" type="model"><components>{inside}</components></object>'
            child = str(100 + k)
        return (text[:ends] + chain + text[ends:]).encode()

    return change


def test_components_that_amount_to_too_many_bodies_are_refused(tmp_path, good):
    """10**30 of them: refused before they are expanded, or this would never end."""
    path = with_model(good, tmp_path / "bad.3mf", chained(30, 10))
    with pytest.raises(InputError, match="its components amount to more than 10000 objects"):
        read_threemf(path)


def test_components_of_themselves_are_refused(tmp_path, good):
    path = with_model(good, tmp_path / "bad.3mf", chained(1, 1, last="100"))
    with pytest.raises(InputError, match="object 100 is a component of itself"):
        read_threemf(path)
