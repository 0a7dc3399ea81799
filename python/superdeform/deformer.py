"""A character together with the deformation that gives it a style: made once, applied as often as something changes."""

import ctypes as c
import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import abi
from .character import Character
from .library import Handle, Progress, array, at, call, reports, text
from .options import options
from .style import Style


@dataclass(frozen=True)
class Deformed:
    """What comes out of one mesh: vertices x 3, tangents x 4, morph targets x vertices x 3; None where none came in."""

    positions: np.ndarray
    normals: np.ndarray | None
    tangents: np.ndarray | None
    morphs: np.ndarray | None


class Deformer(Handle):
    """Gives a character a style; `given`: as in `superdeform.options`.

    Raises Error, here and in every method; after one of a change, all is as it was.
    """

    def __init__(self, character: Character, style: Style, progress: Progress | None = None, **given: Any):
        asked, callback, made = options(**given), reports(progress), abi.SdefDeformer()
        call("deformer_create", character._handle, style._handle, c.byref(asked), callback, None, c.byref(made))
        super().__init__(made.id)
        self._meshes = [dict(mesh) for mesh in character._meshes]

    @property
    def _handle(self) -> abi.SdefDeformer:
        return abi.SdefDeformer(self._number)

    def set_options(self, progress: Progress | None = None, **given: Any) -> None:
        """Changes the options, with the same results as a new deformer and for less."""
        asked, callback = options(**given), reports(progress)
        call("deformer_set_options", self._handle, c.byref(asked), callback, None)

    def set_style(self, style: Style, progress: Progress | None = None) -> None:
        """Changes the style, with the same results as a new deformer and for less."""
        callback = reports(progress)
        call("deformer_set_style", self._handle, style._handle, callback, None)

    def room(self, normals: bool = True, tangents: bool = True, morphs: bool = True) -> list[Deformed]:
        """Arrays for `apply` to write into, one after another as a slider moves; what is left out is not made."""
        def floats(wanted: bool, *shape: int) -> np.ndarray | None:
            return np.zeros(shape, np.float32) if wanted else None

        return [Deformed(np.zeros((mesh["count"], 3), np.float32), floats(normals and mesh["normals"], mesh["count"], 3),
                         floats(tangents and mesh["tangents"], mesh["count"], 4),
                         floats(morphs and mesh["targets"] > 0, mesh["targets"], mesh["count"], 3)) for mesh in self._meshes]

    def apply(self, into: Sequence[Deformed] | None = None, progress: Progress | None = None) -> Sequence[Deformed]:
        """Deforms the meshes; `into`: what `room` gave, which is written without a copy and given back."""
        into = self.room() if into is None else into
        rows = (abi.SdefMeshResult * len(into))()
        for row, mesh in zip(rows, into):
            row.struct_size, row.vertex_capacity = c.sizeof(row), len(mesh.positions)
            row.positions, row.normals, row.tangents = at(mesh.positions), at(mesh.normals), at(mesh.tangents)
            if mesh.morphs is not None:
                row.morph_target_capacity, row.morph_positions = len(mesh.morphs), at(mesh.morphs)
        callback = reports(progress)
        call("deformer_apply", self._handle, rows, len(rows), callback, None)
        return into

    def joints(self) -> np.ndarray:
        """Where the joints are now, joints x 3; they neither turn nor scale."""
        count = c.c_size_t()
        call("deformer_get_joints", self._handle, None, None, 0, c.byref(count))
        positions = np.empty((count.value, 3))
        call("deformer_get_joints", self._handle, at(positions), None, count.value, None)
        return positions

    def map_points(self, joints: ArrayLike, points: ArrayLike) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Maps points that move with joints: their places, by how much small things there grow, and how directions change.

        - `joints`: a joint a point; `points`: points x 3.
        - Returns points x 3, points, points x 3 x 3 (for column vectors).
        """
        points = array(points, np.float64, -1, 3)
        joints = array(joints, np.uint32, len(points))
        places, scales, jacobians = np.empty_like(points), np.empty(len(points)), np.empty((len(points), 3, 3))
        call("deformer_map_points", self._handle, at(joints), at(points), len(points), at(places), at(scales), at(jacobians))
        return places, scales, np.swapaxes(jacobians, 1, 2)

    def map_colliders(self, colliders: Sequence[abi.SdefCollider], springs: Sequence[abi.SdefSpringBall] = ()) -> list[abi.SdefCollider]:
        """Maps colliders of springs, as sdef_deformer_map_colliders has it; `struct_size` is filled in here."""
        rows, balls = (abi.SdefCollider * len(colliders))(*colliders), (abi.SdefSpringBall * len(springs))(*springs)
        for row in (*rows, *balls):
            row.struct_size = c.sizeof(row)
        if len(rows):
            call("deformer_map_colliders", self._handle, rows, len(rows), balls if len(balls) else None, len(balls), rows)
        return list(rows)

    def report(self) -> dict[str, Any]:
        """Measures the result: figures, groups, joints, times, warnings. As slow as an apply and a measurement."""
        size = c.c_size_t()
        call("deformer_get_report", self._handle, None, None, 0, c.byref(size))
        written = c.create_string_buffer(size.value)
        call("deformer_get_report", self._handle, None, written, size.value, None)
        return json.loads(written.value)

    def warnings(self) -> list[str]:
        """What was found, a line each: "code: sentence"."""
        return text("get_warnings", self._number).splitlines()
