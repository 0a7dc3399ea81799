"""Installs the built zip in a fresh profile, as a user does: the panel is there, and the library loads."""

import os

import bpy

import addon_utils  # There once bpy is.

bpy.ops.wm.read_factory_settings(use_empty=True)
addon_utils.enable("bl_pkg")
assert not hasattr(bpy.types.Scene, "superdeform"), "the profile is fresh"
done = bpy.ops.extensions.package_install_files(filepath=os.environ["SUPERDEFORM_ZIP"], repo="user_default", enable_on_install=True)
assert done == {"FINISHED"}, done
assert hasattr(bpy.types.Scene, "superdeform") and bpy.types.VIEW3D_PT_superdeform.bl_category == "Superdeform"
import superdeform  # noqa: E402

assert os.environ["BLENDER_USER_RESOURCES"] in superdeform.__file__, superdeform.__file__
bpy.ops.wm.save_userpref()
print(f"Blender {bpy.app.version_string}: installed, library {superdeform.version()}")
