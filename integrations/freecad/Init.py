# Runs when FreeCAD starts, and puts this folder among those in which FreeCAD looks for posts. FreeCAD 1.2
# finds it by package.xml.
def register():
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
    preferences.searchPathsPost = lambda: searched() + [folder]


register()
