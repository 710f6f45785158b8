"""Runs when FreeCAD starts: puts this folder among those in which FreeCAD looks for posts."""


def register():
    """Add the folder, unless FreeCAD finds it by `package.xml`, as from 1.2 on."""
    import os

    import toolpost_job

    try:
        import Path.Preferences as preferences
    except ImportError:
        import PathScripts.PathPreferences as preferences
    if hasattr(preferences, "addAddonPostPath"):
        return
    folder = os.path.dirname(toolpost_job.__file__)
    searched = preferences.searchPathsPost
    preferences.searchPathsPost = lambda: [*searched(), folder]


register()
