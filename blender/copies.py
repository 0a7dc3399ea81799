# SPDX-License-Identifier: MIT OR Apache-2.0
"""A second set of objects whose pointers (parents, modifiers, constraints, drivers, add-ons' settings) lead to one another."""

from contextlib import contextmanager

import bpy

# Says which object a copy was made from, while copies are made.
_MARK = "superdeform_from"


@contextmanager
def object_mode(context):
    """Object mode, with nothing selected; afterwards mode, selection and active object are as they were."""
    layer = context.view_layer
    active, mode = layer.objects.active, context.mode
    object_mode_of = active.mode if active else "OBJECT"
    selected = [thing for thing in layer.objects if thing.select_get(view_layer=layer)]
    if mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for thing in selected:
        thing.select_set(False, view_layer=layer)
    try:
        yield
    finally:
        if layer.objects.active and layer.objects.active.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for thing in list(layer.objects):
            thing.select_set(thing in selected, view_layer=layer)
        if active is None or active.name in layer.objects:
            layer.objects.active = active
        if active and object_mode_of != "OBJECT" and active.name in layer.objects and not active.hide_get():
            bpy.ops.object.mode_set(mode=object_mode_of)


def belonging(armature, meshes):
    """The armature, its meshes and all that hangs from these."""
    everything = {armature, *meshes}
    while True:
        more = {thing for thing in bpy.data.objects if thing.parent in everything} - everything
        if not more:
            return sorted(everything, key=lambda thing: thing.name)
        everything |= more


def copied(context, things, name):
    """A collection `name` of the scene with a copy of each object, and the copies by the names of what they were made from.

    Needs object mode. Hidden objects are copied too, and the copies of what is hidden by its eye are hidden.
    """
    scene, layer = context.scene, context.view_layer
    home = bpy.data.collections.new(name)
    scene.collection.children.link(home)
    hidden = {}
    for thing in things:
        # Linked here so that it is in the view layer, whatever collections are excluded.
        home.objects.link(thing)
    layer.update()
    try:
        for thing in things:
            hidden[thing.name] = (thing.hide_viewport, thing.hide_get(view_layer=layer), thing.hide_select)
            thing.hide_viewport = thing.hide_select = False
            thing.hide_set(False, view_layer=layer)
            thing[_MARK] = thing.name
            thing.select_set(True, view_layer=layer)
        layer.objects.active = things[0]
        before = set(bpy.data.objects)
        bpy.ops.object.duplicate(linked=False)
        made = {thing[_MARK]: thing for thing in set(bpy.data.objects) - before}
    finally:
        for thing in things:
            thing.select_set(False, view_layer=layer)
            thing.hide_viewport, eye, thing.hide_select = hidden.get(thing.name, (thing.hide_viewport, False, thing.hide_select))
            thing.hide_set(eye, view_layer=layer)
            if _MARK in thing:
                del thing[_MARK]
            home.objects.unlink(thing)
    for source, thing in made.items():
        del thing[_MARK]
        for collection in list(thing.users_collection):
            collection.objects.unlink(thing)
        home.objects.link(thing)
        thing.select_set(False, view_layer=layer)
        thing.hide_viewport, eye, thing.hide_select = hidden[source]
        layer.update()
        thing.hide_set(eye, view_layer=layer)
        _own_data(bpy.data.objects[source], thing)
    return home, made


def _own_data(source, copy):
    """Data that the user's preferences would have shared, or that objects share with one another, is copied: each is deformed where
    its object is."""
    if copy.type in {"MESH", "ARMATURE"} and (copy.data is source.data or copy.data.users > 1):
        copy.data = copy.data.copy()


def removed(collection):
    """Removes a collection with its objects and their data."""
    for thing in list(collection.objects):
        data = thing.data
        bpy.data.objects.remove(thing)
        if data is not None and data.users == 0:
            (bpy.data.meshes if isinstance(data, bpy.types.Mesh) else bpy.data.armatures).remove(data)
    bpy.data.collections.remove(collection)
