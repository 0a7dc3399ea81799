"""A character as arrays: meshes, joints, weights."""

import ctypes as c
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import abi
from .library import Handle, Progress, array, at, call, reports, text
from .options import options

KINDS = {name.removeprefix("SDEF_MESH_").lower(): number for name, number in vars(abi).items() if name.startswith("SDEF_MESH_")}
"""Kinds of meshes by name: "unknown", "body", "garment", "hair", "face_part", "accessory", "eye"."""


def _role(name: str) -> str:
    first, *rest = name.removeprefix("SDEF_ROLE_").lower().split("_")
    return first + "".join(word.capitalize() for word in rest)


ROLES = {_role(name): number for name, number in vars(abi).items() if name.startswith("SDEF_ROLE_") and name != "SDEF_ROLE_COUNT"}
"""Humanoid roles by the names of VRM 1.0: "hips", "leftUpperLeg"."""


@dataclass(frozen=True)
class Joints:
    """All joints of a character; `roles` has -1 where a joint plays none, `rest` a matrix a joint, for column vectors."""

    parents: np.ndarray
    roles: np.ndarray
    rest: np.ndarray
    confidence: np.ndarray


class Character(Handle):
    """A character in rest pose, in any units; one space for everything.

    - `up`, `forward`: directions; found where they are not given (`up` is then (0, 1, 0)).

    Raises Error, here and in every method.
    """

    def __init__(self, up: ArrayLike | None = None, forward: ArrayLike | None = None):
        up, forward = (None if axis is None else array(axis, np.float32, 3) for axis in (up, forward))
        made = abi.SdefCharacter()
        call("character_create", at(up), at(forward), c.byref(made))
        super().__init__(made.id)
        self._meshes: list[dict[str, Any]] = []

    @property
    def _handle(self) -> abi.SdefCharacter:
        return abi.SdefCharacter(self._number)

    def set_skeleton(self, parents: ArrayLike, rest: ArrayLike, names: Sequence[str] | None = None,
                     roles: Mapping[str, int] | None = None) -> None:
        """Gives the character its joints; comes before meshes with weights.

        - `parents`: a number a joint, -1 for none.
        - `rest`: joints x 4 x 4, joint space to model space, for column vectors.
        - `names`: by which roles are guessed where `roles` are not given.
        - `roles`: joint by role, as `ROLES` names them.
        """
        parents = array(parents, np.int32, -1)
        matrices = array(np.swapaxes(np.asarray(rest, np.float64), 1, 2), np.float64, len(parents), 4, 4)
        texts = (c.c_char_p * len(parents))(*[name.encode() for name in names]) if names is not None else None
        played = np.full(abi.SDEF_ROLE_COUNT, -1, np.int32)
        for role, joint in (roles or {}).items():
            played[ROLES[role]] = joint
        skeleton = abi.SdefSkeleton(struct_size=c.sizeof(abi.SdefSkeleton), joint_count=len(parents), parents=at(parents),
                                    rest_matrices=at(matrices), names=c.addressof(texts) if texts else None)
        if roles:
            skeleton.role_count, skeleton.role_joints = len(played), at(played)
        call("character_set_skeleton", self._handle, c.byref(skeleton))

    def add_image(self, grey: ArrayLike) -> int:
        """Adds an image that meshes show: rows x columns of bytes, brightness as screens show it, the row of v = 0 first.

        Returns what `add_mesh` names it by.
        """
        grey = array(grey, np.uint8, -1, -1)
        image = abi.SdefImage(struct_size=c.sizeof(abi.SdefImage), width=grey.shape[1], height=grey.shape[0], pixels=at(grey))
        number = c.c_uint32()
        call("character_add_image", self._handle, c.byref(image), c.byref(number))
        return number.value

    def add_mesh(self, positions: ArrayLike, triangles: ArrayLike, name: str = "", kind: str = "unknown",
                 joints: ArrayLike | None = None, weights: ArrayLike | None = None, row_starts: ArrayLike | None = None,
                 normals: ArrayLike | None = None, tangents: ArrayLike | None = None, uvs: ArrayLike | None = None,
                 image: int = 0) -> int:
        """Adds a mesh; everything is copied. Returns its index.

        - `positions`, `normals`: vertices x 3; `tangents`: vertices x 4; `uvs`: vertices x 2.
        - `triangles`: triangles x 3 vertices.
        - `joints`, `weights`: vertices x influences; or flat, with `row_starts` (vertices + 1 numbers).
        - `name`: "node/mesh/material", for messages and for guessing the kind; `kind`: one of `KINDS`.
        """
        positions = array(positions, np.float32, -1, 3)
        count = len(positions)
        triangles = array(triangles, np.uint32, -1, 3)
        kept = {"positions": positions, "indices": triangles}
        for what, given, width in (("normals", normals, 3), ("tangents", tangents, 4), ("uvs", uvs, 2)):
            if given is not None:
                kept[what] = array(given, np.float32, count, width)
        mesh = abi.SdefMesh(struct_size=c.sizeof(abi.SdefMesh), kind=KINDS[kind], name=name.encode(), vertex_count=count,
                            index_count=triangles.size, image=image)
        if joints is not None and np.size(joints):
            flat = row_starts is not None
            shape = (-1,) if flat else (count, -1)
            kept["joints"], kept["weights"] = array(joints, np.uint32, *shape), array(weights, np.float32, *shape)
            if kept["joints"].shape != kept["weights"].shape:
                raise ValueError(f"there are {kept['joints'].shape} joints and {kept['weights'].shape} weights: give one for each")
            if flat:
                kept["row_starts"] = array(row_starts, np.uint32, count + 1)
            mesh.influence_count = kept["joints"].shape[-1]
        for what, numbers in kept.items():
            setattr(mesh, what, at(numbers))
        index = c.c_uint32()
        call("character_add_mesh", self._handle, c.byref(mesh), c.byref(index))
        self._meshes.append({"count": count, "normals": normals is not None, "tangents": tangents is not None, "targets": 0})
        return index.value

    def add_morph_target(self, mesh: int, positions: ArrayLike, name: str = "", normals: ArrayLike | None = None) -> None:
        """Adds a morph target to a mesh: what is added to each vertex at weight 1, vertices x 3."""
        count = self._meshes[mesh]["count"] if mesh < len(self._meshes) else -1
        positions = array(positions, np.float32, count, 3)
        normals = None if normals is None else array(normals, np.float32, count, 3)
        target = abi.SdefMorphTarget(struct_size=c.sizeof(abi.SdefMorphTarget), name=name.encode(), positions=at(positions),
                                     normals=at(normals))
        call("character_add_morph_target", self._handle, mesh, c.byref(target))
        self._meshes[mesh]["targets"] += 1

    def rig(self, progress: Progress | None = None, **given: Any) -> None:
        """Finds joints and weights for a character without; `given`: options that begin with `rig_`, and `thread_count`."""
        asked, callback = options(**given), reports(progress)
        call("character_rig", self._handle, c.byref(asked), callback, None)

    def joints(self) -> Joints:
        """The joints: own ones first, then those of a made rig."""
        info = abi.SdefCharacterInfo(struct_size=c.sizeof(abi.SdefCharacterInfo))
        call("character_get_info", self._handle, c.byref(info))
        count = info.joint_count
        parents, roles = np.empty(count, np.int32), np.empty(count, np.int32)
        rest, confidence = np.empty((count, 4, 4)), np.empty(count)
        call("character_get_joints", self._handle, at(parents), at(roles), at(rest), at(confidence), count, None)
        return Joints(parents, roles, np.swapaxes(rest, 1, 2), confidence)

    def weights(self, mesh: int, influences: int = 4) -> tuple[np.ndarray, np.ndarray]:
        """The joints and weights that animate a mesh, vertices x influences, the largest first."""
        count = self._meshes[mesh]["count"] if mesh < len(self._meshes) else 0
        joints, weights = np.empty((count, influences), np.uint32), np.empty((count, influences), np.float32)
        call("character_get_weights", self._handle, mesh, influences, at(joints), at(weights), count)
        return joints, weights

    def warnings(self) -> list[str]:
        """What was found about rig and roles, a line each: "code: sentence"."""
        return text("get_warnings", self._number).splitlines()
