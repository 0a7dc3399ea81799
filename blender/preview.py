# SPDX-License-Identifier: MIT OR Apache-2.0
"""Live preview: while a slider moves, places alone; when it is let go, keys, normals and rest bones too."""

import bpy
import numpy as np
from bpy.app.handlers import persistent
from superdeform import Error

from . import copies, refuse, settings, write
from .character import Deformation, Figure, style_of
from .read import numbers, rest_world

# Seconds without a change after which a slider counts as let go.
_PAUSE = 0.3

_current = None


class Preview:
    """A collection of copies that follow the panel."""

    _asked = None

    def __init__(self, context, given):
        armature = refuse.armature_of(context.object)
        self.armature = armature.name
        with copies.object_mode(context):
            self.deformation = Deformation(Figure(armature), self._style_of(given), settings.options(given))
            collection, made, self.notes = write.character(context, self.deformation, f"{armature.name} preview")
        self.collection = collection.name
        self.made = {name: thing.name for name, thing in made.items()}
        self._look_back(made)
        # What is hidden is no longer selected.
        self.before = {name: (bpy.data.objects[name].hide_get(), bpy.data.objects[name].select_get()) for name in self.made}
        for name in self.made:
            bpy.data.objects[name].hide_set(True)

    def _look_back(self, made):
        """Keeps what stays while a slider moves: what takes world space to that of each mesh, and how far its shape keys carry it."""
        self.backs = {source.name: write.back_of(source, made[source.name]) for source in self.deformation.figure.sources}
        self.carried = {name: _carried(made[name], back) for name, back in self.backs.items()}
        self.shown = None

    def _hide_keys(self, made):
        """Mutes shape keys, which hold the places of all vertices and would keep them there, until the slider is let go."""
        if self.shown is None:
            self.shown = [(name, key.name) for name, moved in self.carried.items() if moved is not None
                          for key in made[name].data.shape_keys.key_blocks if not key.mute]
            self._mute(made, True)

    def _mute(self, made, muted):
        for name, key in self.shown or ():
            if key in made[name].data.shape_keys.key_blocks:
                made[name].data.shape_keys.key_blocks[key].mute = muted

    def objects(self):
        """The copies by the names of what they were made from; None where one is gone."""
        found = {name: bpy.data.objects.get(copy) for name, copy in self.made.items()}
        return found if all(found.values()) and self.armature in bpy.data.objects else None

    def _style_of(self, given):
        """The style that is asked for; a file or another character is measured once, not as often as a slider moves."""
        asked = (given.style, given.heads, given.path, given.like)
        if asked != self._asked:
            self._style, self._asked = style_of(given), asked
        return self._style

    def slide(self, given):
        """Follows the settings with places alone."""
        made = self.objects()
        if made is None:
            return
        self.deformation.set(self._style_of(given), settings.options(given) | {"repair": "kept"})
        placed = self.deformation.positions()
        self._hide_keys(made)
        for source in self.deformation.figure.sources:
            thing, places, moved = made[source.name], placed[source.name], self.carried[source.name]
            write.put(thing.data, places if moved is None else places + moved, self.backs[source.name])
            thing.data.update()

    def settle(self, context, given):
        """Follows the settings with everything."""
        made = self.objects()
        if made is None:
            return
        self.deformation.deformer.set_options(**settings.options(given))
        self._mute(made, False)
        armature = bpy.data.objects[self.armature]
        places = {name: rest_world(armature, bpy.data.objects[name]) for name in made}
        with copies.object_mode(context):
            write.reshape(context, self.deformation, armature, made, places)
        self._look_back(made)

    def remove(self):
        """Takes the copies away and shows what they were made from."""
        if self.collection in bpy.data.collections:
            copies.removed(bpy.data.collections[self.collection])
        for name, (hidden, selected) in self.before.items():
            if name in bpy.data.objects:
                bpy.data.objects[name].hide_set(hidden)
                bpy.data.objects[name].select_set(selected)


def _carried(thing, back):
    """How far the shape keys of a mesh carry its vertices now, in world space; None where they leave them."""
    keys = thing.data.shape_keys
    if not keys or not any(key.value and not key.mute for key in keys.key_blocks[1:]):
        return None
    mixed = thing.shape_key_add(from_mix=True)
    first, last = (numbers(key.data, "co", 3 * len(key.data)).reshape(-1, 3) for key in (keys.reference_key, mixed))
    thing.shape_key_remove(mixed)
    return ((last - first) @ np.linalg.inv(back)[:3, :3].T).astype(np.float32)


def toggle(given, context):
    """The panel's switch."""
    global _current
    if _current is not None:
        _current.remove()
        _current = None
    given.fault = ""
    if given.preview:
        try:
            _current = Preview(context, given)
        except (Error, refuse.Refused) as fault:
            given.fault = str(fault)


def changed(given, context):
    """A setting of the panel has another value."""
    if _current is None:
        return
    given.fault = ""
    try:
        _current.slide(given)
    except (Error, refuse.Refused) as fault:
        given.fault = str(fault)
    if bpy.app.timers.is_registered(_let_go):
        bpy.app.timers.unregister(_let_go)
    bpy.app.timers.register(_let_go, first_interval=_PAUSE)


def _let_go():
    if _current is not None:
        try:
            _current.settle(bpy.context, bpy.context.scene.superdeform)
        except (Error, refuse.Refused) as fault:
            bpy.context.scene.superdeform.fault = str(fault)


def stop():
    """Ends a preview without the panel."""
    global _current
    if _current is not None:
        _current.remove()
        _current = None


@persistent
def _before_saving(*_):
    """A file is saved with the character, not with a preview that nobody would end."""
    for scene in bpy.data.scenes:
        scene.superdeform.preview = False


@persistent
def _before_loading(*_):
    """What is shown belongs to a file that goes."""
    global _current
    _current = None


_HANDLERS = ((bpy.app.handlers.save_pre, _before_saving), (bpy.app.handlers.load_pre, _before_loading))


def register():
    for handlers, handler in _HANDLERS:
        handlers.append(handler)


def unregister():
    stop()
    for handlers, handler in _HANDLERS:
        handlers.remove(handler)
