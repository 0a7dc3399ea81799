# SPDX-License-Identifier: MIT OR Apache-2.0
"""A character of the scene, given to the library: read once, deformed as often as a slider moves."""

import hashlib
from pathlib import Path

import bpy
import numpy as np
import superdeform

from . import refuse, roles, skeleton
from .read import Source, grey_of

UP = (0, 0, 1)


def give(character, meshes, sources, tell=lambda given: None):
    """Gives meshes with their images, weights and shape keys to the library; `tell` is called with all that is given.

    Returns of each mesh that the library has: its source, the split vertices that it has, and which vertices those were.
    """
    parts, images = [], {}
    for mesh, source in zip(meshes, sources):
        for slot, used, triangles in source.parts():
            material = mesh.material_slots[slot].material if slot < len(mesh.material_slots) else None
            name = material.name if material else ""
            if source.has_uv and name not in images:
                grey = grey_of(material)
                images[name] = 0 if grey is None else character.add_image(grey)
            of = source.of[used]
            places, (joints, weights, starts) = source.to_world(source.local)[of], source.rows(of)
            shown = images[name] if source.has_uv else 0
            label = f"{mesh.name}/{mesh.data.name}/{name}"
            for given in (label.encode(), places, source.normals[used], triangles, joints, weights, starts,
                          *(moved[of] for _, _, moved in source.keys)):
                tell(given if isinstance(given, bytes) else np.ascontiguousarray(given).tobytes())
            number = character.add_mesh(
                places, triangles, label, joints=joints, weights=weights,
                row_starts=starts, normals=source.normals[used], uvs=source.uv[used] if shown else None, image=shown)
            for key, _, moved in source.keys:
                character.add_morph_target(number, moved[of], key)
            parts.append((source, used, of))
    return parts


class Figure:
    """The meshes and bones of an armature, as the library has them. Needs object mode: others keep the truth elsewhere."""

    def __init__(self, armature):
        self.armature = armature.name
        meshes = refuse.meshes_of(armature)
        refuse.check(armature, meshes)
        self.joints, self.controls = skeleton.joints_of(armature, meshes)
        self.sources = [Source(mesh, armature, self.joints.of_bone) for mesh in meshes]
        self.character = superdeform.Character(up=UP)
        self.character.set_skeleton(self.joints.parents, self.joints.rest, self.joints.names,
                                    roles.roles_of(armature, self.joints.of_bone))
        self._digest = hashlib.sha1(repr((self.joints.names, self.joints.parents, armature.name)).encode())
        self._digest.update(np.array(self.joints.rest).tobytes())
        self.parts = give(self.character, meshes, self.sources, self._digest.update)

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

    def hip_ratio(self):
        """New over old height of the hips above the lowest vertex; 1 where that tells nothing."""
        hips = np.flatnonzero(self.figure.character.joints().roles == superdeform.character.ROLES["hips"])
        if not len(hips):
            return 1.0
        before = self.figure.joints.rest[hips[0]][2, 3] - min(source.to_world(source.local)[:, 2].min() for source in self.figure.sources)
        after = self.deformer.joints()[hips[0]][2] - min(places[:, 2].min() for places in self.positions().values())
        return after / before if before > 0 and after > 0 else 1.0

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
