"""Documents that are damaged: FreeCAD opens them in part and says nothing, we refuse them."""

import json
import zipfile

import pytest
from conftest import ADDON, freecad


def rewritten(source, target, change):
    """Copy a document; `change` answers what becomes of each file of it, or None."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            data = change(name, old.read(name))
            if data is not None:
                new.writestr(name, data)


def truncated(source, target):
    data = source.read_bytes()
    target.write_bytes(data[: len(data) * 2 // 3])


def flipped(source, target):
    with zipfile.ZipFile(source) as archive:
        info = archive.getinfo("Plan.nc")
    data = bytearray(source.read_bytes())
    data[info.header_offset + 30 + len("Plan.nc") + info.compress_size // 2] ^= 255
    target.write_bytes(data)


def without_a_path(source, target):
    rewritten(source, target, lambda name, data: None if name == "Plan.nc" else data)


def with_half_a_path(source, target):
    rewritten(
        source, target, lambda name, data: data[: len(data) // 2] if name == "Plan.nc" else data
    )


def with_half_a_document(source, target):
    rewritten(
        source,
        target,
        lambda name, data: data[: len(data) // 2] if name == "Document.xml" else data,
    )


def in_another_order(source, target):
    """FreeCAD reads the files in the order of the document, and passes over the others."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        names = old.namelist()
        for name in [names[0], *reversed(names[1:])]:
            new.writestr(name, old.read(name))


DAMAGES = {
    truncated: "File is not a zip file",
    flipped: "Plan.nc",
    without_a_path: "Plan.nc is missing",
    with_half_a_path: "the path of Plan is not whole",
    with_half_a_document: "line ",
    in_another_order: "is not whole",
}


def read(document, folder, code):
    """Answer what FreeCAD prints last when the document is read, and where its job is."""
    target = folder / "job.json"
    said = freecad(
        ADDON / "toolpost_job.py", folder, code, TOOLPOST_FCSTD=document, TOOLPOST_JSON=target
    )
    return said.strip().splitlines()[-1], target


def test_a_whole_document_is_read(jobs, tmp_path):
    _, target = read(jobs / "several-Tool.FCStd", tmp_path, 0)
    assert json.loads(target.read_text())["operations"]


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda damage: damage.__name__)
def test_a_damaged_document_is_refused(jobs, tmp_path, damage):
    document = tmp_path / "damaged.FCStd"
    damage(jobs / "several-Tool.FCStd", document)
    said, target = read(document, tmp_path, 1)
    assert said.startswith("the document is damaged (")
    assert DAMAGES[damage] in said
    assert "save it again in FreeCAD" in said
    assert not target.exists()
