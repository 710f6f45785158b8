"""The post in FreeCAD's window: the add-on is found, and only what is proven leaves the editor."""

import json
import os
import shutil
from pathlib import Path

import pytest
from conftest import ADDON, HERE, absent, missing, run

PICTURES = ["freecad-job", "freecad-editor", "freecad-not-proven"]


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    """Post in the window; with TOOLPOST_IMAGES the pictures of it go to that folder."""
    if missing():
        absent(missing())
    if shutil.which("xvfb-run") is None:
        absent("a screen for FreeCAD's window (Debian packages xvfb, xauth) is not installed")
    home = tmp_path_factory.mktemp("home")
    (home / "Mod").mkdir()
    (home / "Mod" / "toolpost").symlink_to(ADDON, target_is_directory=True)
    shutil.copy(HERE / "user.cfg", home)
    folder = tmp_path_factory.mktemp("window")
    screen = ["xvfb-run", "-a", "-s", "-screen 0 1200x800x24"]
    said = run([*screen, "freecad", HERE / "window.py"], home, TOOLPOST_WINDOW=folder)
    found = json.loads((folder / "window.json").read_text())
    images = os.environ.get("TOOLPOST_IMAGES")
    for name in PICTURES:
        picture = folder / f"{name}.png"
        assert picture.stat().st_size < 300_000
        if images:
            shutil.copy(picture, Path(images))
    return {**found, "said": said}


def test_the_add_on_offers_the_post(window):
    assert "toolpost" in window["offered"]


def test_every_dialog_was_answered(window):
    posts = {name: post for name, post in window.items() if isinstance(post, dict)}
    assert not [name for name, post in posts.items() if post["left"] or post["unexpected"]]


def test_what_is_not_changed_is_saved_as_it_is(window):
    post = window["as it is"]
    assert post["saved"] == post["shown"][0]


def test_a_comment_is_proven_and_reported(window):
    post = window["comment"]
    assert post["saved"] == post["shown"][0].replace("M30", "; ready\nM30")
    assert "edited: + M30" in window["said"]


def test_another_motion_is_not_saved(window):
    post = window["moved"]
    assert post["saved"] is None
    assert "not proven" in post["shown"][1]
    assert "X102.6" in post["shown"][1]


def test_what_was_put_right_is_saved(window):
    post = window["moved and put right"]
    assert "X102.6" in post["shown"][2], "the editor opens with what was edited"
    assert post["saved"] == post["shown"][0]


def test_a_robot_is_posted_to_like_a_mill(window):
    post = window["robot"]
    assert post["saved"] == post["shown"][0], window["said"]
    assert "\nDEF block ( )\n" in post["saved"]
    assert "kuka-kr6-r900" in window["said"]


def test_cancel_saves_nothing(window):
    assert window["cancelled"]["saved"] is None
    assert "cancelled, nothing was saved" in window["said"]
