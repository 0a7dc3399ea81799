# SPDX-License-Identifier: MIT OR Apache-2.0
"""A character of the scene, given to the library: read once, deformed as often as a slider moves."""

import hashlib
from pathlib import Path

import bpy
import numpy as np
import superdeform

from . import refuse, roles, skeleton
from .read import Source, grey_of

_UP = (0, 0, 1)


class Figure:
    """The meshes and bones of an armature, as the library has them."""

    def __init__(self, armature):
        self.armature = armature.name
        meshes = refuse.meshes_of(armature)
        refuse.check(armature, meshes)
        self.joints, self.controls = skeleton.joints_of(armature, meshes)
        self.sources = [Source(mesh, armature, self.joints.of_bone) for mesh in meshes]
        self.character = superdeform.Character(up=_UP)
        self.character.set_skeleton(self.joints.parents, self.joints.rest, self.joints.names,
                                    roles.roles_of(armature, self.joints.of_bone))
        self.parts, images = [], {}
        self._digest = hashlib.sha1(repr((self.joints.names, self.joints.parents, armature.name)).encode())
        self._digest.update(np.array(self.joints.rest).tobytes())
        for mesh, source in zip(meshes, self.sources):
            for slot, used, triangles in source.parts():
                material = mesh.material_slots[slot].material if slot < len(mesh.material_slots) else None
                self._add(source, mesh, used, triangles, material, images)

    def _add(self, source, mesh, used, triangles, material, images):
        name = material.name if material else ""
        if source.has_uv and name not in images:
            grey = grey_of(material)
            images[name] = 0 if grey is None else self.character.add_image(grey)
        of = source.of[used]
        places, (joints, weights, starts) = source.to_world(source.local)[of], source.rows(of)
        shown = images[name] if source.has_uv else 0
        label = f"{mesh.name}/{mesh.data.name}/{name}"
        for given in (label.encode(), places, source.normals[used], triangles, joints, weights, starts,
                      *(moved[of] for _, _, moved in source.keys)):
            self._digest.update(given if isinstance(given, bytes) else np.ascontiguousarray(given).tobytes())
        number = self.character.add_mesh(
            places, triangles, label, joints=joints, weights=weights,
            row_starts=starts, normals=source.normals[used], uvs=source.uv[used] if shown else None, image=shown)
        for key, _, moved in source.keys:
            self.character.add_morph_target(number, moved[of], key)
        self.parts.append((source, used, of))

    @property
    def digest(self):
        """The same for a figure that is read again and was not changed, but for what is painted on it."""
        return self._digest.digest()


class Deformation:
    """A figure with a style; arrays are made once and written again and again."""

    def __init__(self, figure, style, options):
        self.figure = figure
        self.deformer = superdeform.Deformer(figure.character, style, **options)
        self.whole = self.deformer.room(tangents=False)
        self.quick = [superdeform.Deformed(mesh.positions, None, None, None) for mesh in self.whole]
        self.placed = {source.name: source.to_world(source.local) for source in figure.sources}

    def set(self, style, options):
        """Changes style and options; what does not depend on the change is not done again."""
        self.deformer.set_style(style)
        self.deformer.set_options(**options)

    def positions(self):
        """Places of each mesh in world space, by its name, until the next call; nothing else, for while a slider moves."""
        self.deformer.apply(self.quick)
        for (source, _, of), mesh in zip(self.figure.parts, self.quick):
            self.placed[source.name][of] = mesh.positions
        return self.placed

    def everything(self):
        """Of each mesh by its name: places, what each shape key adds, normals of the split vertices."""
        self.deformer.apply(self.whole)
        made = {}
        for source in self.figure.sources:
            keys = np.zeros((len(source.keys), source.count, 3), np.float32)
            made[source.name] = (source.to_world(source.local), keys, np.zeros((len(source.of), 3), np.float32))
        for (source, used, of), mesh in zip(self.figure.parts, self.whole):
            places, keys, normals = made[source.name]
            places[of], normals[used] = mesh.positions, mesh.normals
            if mesh.morphs is not None:
                keys[:, of] = mesh.morphs
        return made


_last = None


def deformation_of(armature, style, options):
    """The deformation of a character; that of the last call, changed, where it is the same character: for redo."""
    global _last
    figure = Figure(armature)
    if _last is not None and _last.figure.digest == figure.digest:
        _last.set(style, options)
    else:
        _last = None
        _last = Deformation(figure, style, options)
    return _last


def style_of(given):
    """The style that settings ask for: "HEADS", "FILE" (GLB, VRM, or the JSON of a saved style) or "ARMATURE" (another character)."""
    path, armature = bpy.path.abspath(given.path), bpy.data.objects.get(given.like)
    if given.style == "HEADS":
        return superdeform.Style.heads(given.heads)
    if given.style == "ARMATURE":
        if armature is None:
            raise refuse.Refused("no armature is chosen to be like: choose one, or ask for a number of heads")
        return superdeform.Style.measure(Figure(armature).character, armature.name)
    file = Path(path)
    if not file.is_file():
        raise refuse.Refused(f"there is no file {path!r}: choose a GLB, a VRM or a saved style")
    if file.suffix.lower() == ".json":
        return superdeform.Style.text(file.read_text(encoding="utf-8"))
    return superdeform.Style.file(file.read_bytes(), file.name)
