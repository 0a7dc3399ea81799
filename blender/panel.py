# SPDX-License-Identifier: MIT OR Apache-2.0
"""The panel in the 3D view's sidebar, and the operator."""

import textwrap

import bpy

from . import refuse

MISSING = refuse.library_fault()
if not MISSING:
    from superdeform import Error

    from . import copies, preview, rig, settings, write
    from .character import deformation_of, style_of

    class SuperdeformSettings(bpy.types.PropertyGroup):
        """What the panel shows."""

        __annotations__ = settings.properties(preview.changed) | {
            "preview": bpy.props.BoolProperty(name="Live Preview", description="Shows the result in place of the character while sliders move", update=preview.toggle),
            "fault": bpy.props.StringProperty(options={"HIDDEN", "SKIP_SAVE"}),
        }

    class OBJECT_OT_superdeform(bpy.types.Operator):
        """Makes a super-deformed copy of the active character in a collection of its own"""

        bl_idname = "object.superdeform"
        bl_label = "Superdeform"
        bl_options = {"REGISTER", "UNDO"}
        __annotations__ = settings.properties()

        @classmethod
        def poll(cls, context):
            return context.object is not None

        def invoke(self, context, event):
            """From the panel: with what it shows."""
            given = context.scene.superdeform
            for name in settings.properties():
                setattr(self, name, getattr(given, name))
            if given.preview:
                given.preview = False
            return self.execute(context)

        def execute(self, context):
            try:
                armature = refuse.armature_of(context.object)
                with copies.object_mode(context):
                    deformation = deformation_of(armature, style_of(self), settings.options(self))
                    collection, made, notes = write.character(context, deformation, f"{armature.name} SD")
            except (Error, refuse.Refused) as fault:
                self.report({"ERROR"}, str(fault))
                return {"CANCELLED"}
            for note in notes:
                self.report({"WARNING"}, note.partition(": ")[2])
            self.report({"INFO"}, f"{len(made)} objects are in the collection {collection.name}")
            return {"FINISHED"}

        def draw(self, context):
            self.layout.use_property_split = True
            settings.draw(self.layout, self)
            settings.draw_groups(self.layout.box(), self)

    class OBJECT_OT_superdeform_rig(bpy.types.Operator):
        """Finds the joints of the selected meshes, which have no armature, and gives them one with weights"""

        bl_idname = "object.superdeform_rig"
        bl_label = "Make a Rig"
        bl_options = {"REGISTER", "UNDO"}

        @classmethod
        def poll(cls, context):
            return bool(refuse.unrigged(context))

        def execute(self, context):
            try:
                meshes = refuse.unrigged(context)
                with copies.object_mode(context):
                    armature, notes = rig.rigged(context, meshes)
            except (Error, refuse.Refused) as fault:
                self.report({"ERROR"}, str(fault))
                return {"CANCELLED"}
            for note in notes:
                self.report({"WARNING"}, note.partition(": ")[2])
            self.report({"INFO"}, f"{armature.name} has {len(armature.data.bones)} bones")
            return {"FINISHED"}


def sentence(layout, text, width=44):
    """A sentence on as many lines as it needs."""
    column = layout.column(align=True)
    for number, line in enumerate(textwrap.wrap(text, width)):
        column.label(text=line, icon="ERROR" if number == 0 else "BLANK1")


class VIEW3D_PT_superdeform(bpy.types.Panel):
    """Settings and the button"""

    bl_label = "Superdeform"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Superdeform"

    def draw(self, context):
        layout = self.layout
        if MISSING:
            return sentence(layout, MISSING)
        given = context.scene.superdeform
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.label(text=context.object.name if context.object else "Select a character", icon="ARMATURE_DATA")
        settings.draw(layout.column(), given)
        row = layout.row()
        row.use_property_split = False
        row.prop(given, "preview", toggle=True, icon="HIDE_OFF" if given.preview else "HIDE_ON")
        if given.fault:
            sentence(layout, given.fault)
        if refuse.unrigged(context):
            layout.operator("object.superdeform_rig", icon="BONE_DATA")
        row = layout.row()
        row.scale_y = 1.4
        row.operator("object.superdeform", text="Make a Copy", icon="OUTLINER_OB_ARMATURE")


class VIEW3D_PT_superdeform_groups(bpy.types.Panel):
    """How much of the style each part of the body takes"""

    bl_label = "Parts of the Body"
    bl_parent_id = "VIEW3D_PT_superdeform"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Superdeform"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return not MISSING

    def draw(self, context):
        self.layout.use_property_split = False
        settings.draw_groups(self.layout.column(), context.scene.superdeform)


_classes = [VIEW3D_PT_superdeform, VIEW3D_PT_superdeform_groups]
if not MISSING:
    _classes = [SuperdeformSettings, OBJECT_OT_superdeform, OBJECT_OT_superdeform_rig, *_classes]


def register():
    for each in _classes:
        bpy.utils.register_class(each)
    if not MISSING:
        bpy.types.Scene.superdeform = bpy.props.PointerProperty(type=SuperdeformSettings)
        preview.register()


def unregister():
    if not MISSING:
        preview.unregister()
        del bpy.types.Scene.superdeform
    for each in reversed(_classes):
        bpy.utils.unregister_class(each)
