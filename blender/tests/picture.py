"""A picture of the panel beside a character and its copy: Debian's Blender under Xvfb, which is older than what the extension needs
and is helped over two differences.

    unzip -d FOLDER superdeform-VERSION.zip && unzip -d FOLDER FOLDER/wheels/*.whl
    xvfb-run -a -s "-screen 0 1500x950x24" blender --factory-startup --enable-event-simulate --window-geometry 0 0 1500 950 \\
        --python blender/tests/picture.py -- FOLDER MODEL OUT.png [unfolded]
"""

import os
import sys
import traceback

import bpy
import numpy as np

folder, model, out, *unfolded = sys.argv[sys.argv.index("--") + 1:]
sys.path[:0] = [folder, os.path.dirname(folder)]
# The importer of this version uses a name that NumPy has no more.
np.bool = bool


class Normals:
    """What a later Blender calls corner_normals."""

    def __init__(self, mesh):
        self.mesh = mesh

    def foreach_get(self, _, numbers):
        self.mesh.calc_normals_split()
        self.mesh.loops.foreach_get("normal", numbers)


def put(data, places, back):
    """As the extension's, for meshes that keep no attribute of places."""
    local = (places @ back[:3, :3].T + back[:3, 3]).astype(np.float32)
    data.vertices.foreach_set("co", local.reshape(-1))
    if data.shape_keys:
        data.shape_keys.reference_key.data.foreach_set("co", local.reshape(-1))
    return local


bpy.types.Mesh.corner_normals = property(Normals)
extension = __import__(os.path.basename(folder), fromlist=["write"])
__import__(f"{extension.__name__}.write", fromlist=["put"]).put = put
if unfolded:
    __import__(f"{extension.__name__}.panel", fromlist=["panel"]).VIEW3D_PT_superdeform_groups.bl_options = set()
extension.register()


def view():
    """The window, its 3D view and the sidebar there."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return window, area, {region.type: region for region in area.regions}


def converted():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.import_scene.gltf(filepath=model)
    armature = next(thing for thing in bpy.data.objects if thing.type == "ARMATURE")
    armature.animation_data_clear()
    for bone in armature.pose.bones:
        bone.matrix_basis.identity()
    bpy.context.view_layer.objects.active = armature
    breadth = max(thing.dimensions.x for thing in bpy.data.objects if thing.type == "MESH")
    bpy.ops.object.superdeform("EXEC_DEFAULT", heads=2.5)
    copies = next(collection for collection in bpy.data.collections if collection.name.endswith(" SD")).objects
    for thing in copies:
        if thing.parent not in list(copies):
            thing.location.x += 0.85 * breadth
    bpy.context.view_layer.objects.active = armature
    return breadth


def begun():
    window, area, regions = view()
    with bpy.context.temp_override(window=window, area=area, region=regions["WINDOW"]):
        breadth = converted()
        space = area.spaces[0]
        space.show_region_ui = True
        space.shading.color_type = "TEXTURE"
        for name in ("show_bones", "show_relationship_lines", "show_cursor", "show_extras", "show_floor", "show_axis_x", "show_axis_y"):
            setattr(space.overlay, name, False)
        bpy.ops.object.select_all(action="DESELECT")
        bpy.ops.view3d.view_axis(type="FRONT")
        space.region_3d.view_perspective = "ORTHO"
        bpy.ops.view3d.view_all()
        space.region_3d.view_distance *= 0.6
        space.region_3d.view_location.x += 0.12 * breadth
    return clicked


def clicked():
    """The tab is the last of four, which tell their heights to nobody."""
    window, _, regions = view()
    sidebar = regions["UI"]
    at = {"x": sidebar.x + sidebar.width - 12, "y": sidebar.y + sidebar.height - 190}
    for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
        window.event_simulate(type=kind, value=value, **at)
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=600, y=400)
    return taken


def taken():
    window, area, _ = view()
    with bpy.context.temp_override(window=window, area=area):
        bpy.ops.screen.screenshot_area(filepath=out)
    os._exit(0)


def steps(step):
    """One step after the other, with time to draw between them."""
    def run():
        try:
            bpy.app.timers.register(steps(step()), first_interval=2)
        except Exception:
            traceback.print_exc()
            os._exit(1)

    return run


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(steps(begun), first_interval=1)
