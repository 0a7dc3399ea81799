# SPDX-License-Identifier: MIT OR Apache-2.0
"""What Blender has of a character, as arrays in world space at rest; nothing is changed."""

import numpy as np
from mathutils import Matrix

# Corners whose texture coordinates differ by less than one of so many steps share a vertex: below what glTF keeps of them.
_UV_STEPS = 65536
# Corners of a vertex share its normal as far as theirs have this cosine, .2 degrees: of normals that a file gives Blender keeps 16
# bits, relative to the triangles around, so that corners of one normal differ by up to .05 degrees.
_SAME_NORMAL = 0.999994


def numbers(things, key, count, kind=np.float32):
    """A property of all elements of a collection."""
    made = np.empty(count, kind)
    things.foreach_get(key, made)
    return made


def tail_of(armature, name):
    """The tail of a bone at rest, in world space, with the bone's turn: what hangs from the bone hangs there."""
    bone = armature.data.bones[name]
    return armature.matrix_world @ bone.matrix_local @ Matrix.Translation((0, bone.length, 0))


def rest_world(armature, thing):
    """Where an object is while its armature is at rest."""
    if thing.parent is armature and thing.parent_type == "BONE" and thing.parent_bone in armature.data.bones:
        return tail_of(armature, thing.parent_bone) @ thing.matrix_parent_inverse @ thing.matrix_basis
    return thing.matrix_world.copy()


def turned(rows, matrix):
    """Normals through a matrix, of unit length."""
    made = rows @ np.linalg.inv(matrix[:3, :3])
    return (made / np.maximum(np.linalg.norm(made, axis=1, keepdims=True), 1e-20)).astype(np.float32)


def unlike(key, normal):
    """Numbers corners of one key by their normals: 0 those that have the first one's, 1 those that have the first one's of the rest,
    and so on."""
    number, left = np.zeros(len(key), np.int32), np.arange(len(key))
    while len(left):
        first, of = np.unique(key[left], return_index=True, return_inverse=True)[1:]
        alike = (normal[left] * normal[left[first[of.reshape(-1)]]]).sum(1) >= _SAME_NORMAL
        # Normals of no length are like nothing, not even themselves.
        alike[first] = True
        left = left[~alike]
        number[left] += 1
    return number


class Source:
    """A mesh, split where corners differ in material, normal or texture coordinate, so that a vertex has one of each.

    - `bones`: joint by name; an object that hangs from a bone is a joint of its own under its name behind a NUL.
    """

    def __init__(self, mesh, armature, bones):
        data = mesh.data
        self.name, self.count = mesh.name, len(data.vertices)
        self.rigid = mesh.parent_type == "BONE" and mesh.parent is armature
        self.world = np.array(rest_world(armature, mesh), np.float64)
        self._keys(data)
        self._corners(data)
        self._weights(mesh, bones)

    def to_world(self, local, kind=np.float32):
        """Places of the mesh in world space."""
        return (local @ self.world[:3, :3].T + self.world[:3, 3]).astype(kind)

    def _keys(self, data):
        self.keys = []
        if not data.shape_keys:
            self.local = numbers(data.vertices, "co", 3 * self.count).reshape(-1, 3)
            return
        places = {key.name: numbers(key.data, "co", 3 * self.count).reshape(-1, 3) for key in data.shape_keys.key_blocks}
        self.local = places[data.shape_keys.reference_key.name]
        for key in data.shape_keys.key_blocks[1:]:
            moved = (places[key.name] - places[key.relative_key.name]) @ self.world[:3, :3].T
            self.keys.append((key.name, key.relative_key.name, moved.astype(np.float32)))

    def _corners(self, data):
        data.calc_loop_triangles()
        corners, triangles = len(data.loops), len(data.loop_triangles)
        vertex = numbers(data.loops, "vertex_index", corners, np.int32)
        triangle = numbers(data.loop_triangles, "loops", 3 * triangles, np.int32)
        material = numbers(data.loop_triangles, "material_index", triangles, np.int32)
        normal = numbers(data.corner_normals, "vector", 3 * corners).reshape(-1, 3)
        uv = np.zeros((corners, 2), np.float32)
        self.has_uv = data.uv_layers.active is not None
        if self.has_uv:
            data.uv_layers.active.uv.foreach_get("vector", uv.reshape(-1))
        of_corner = np.zeros(corners, np.int32)
        of_corner[triangle] = np.repeat(material, 3)
        key = np.zeros(corners, [("material", "i4"), ("vertex", "i4"), ("normal", "i4"), ("uv", "2i4")])
        key["material"], key["vertex"], key["uv"] = of_corner, vertex, np.rint(uv * _UV_STEPS)
        key["normal"] = unlike(key, normal)
        first, split = np.unique(key, return_index=True, return_inverse=True)[1:]
        self.split = split.reshape(-1)
        self.of = vertex[first]
        self.normals = turned(normal[first], self.world)
        self.uv = uv[first] * (1, -1) + (0, 1)
        self.triangles, self.materials = self.split[triangle].reshape(-1, 3), material

    def _weights(self, mesh, bones):
        if self.rigid:
            joint = bones["\0" + mesh.name]
            self.starts = np.arange(self.count + 1)
            self.joints, self.weights = np.full(self.count, joint), np.ones(self.count, np.float32)
            return
        joint_of = np.array([bones.get(group.name, -1) for group in mesh.vertex_groups] + [-1])
        rows = [vertex.groups for vertex in mesh.data.vertices]
        counts = np.fromiter((len(row) for row in rows), np.int64, self.count)
        pairs = np.fromiter((number for row in rows for entry in row for number in (entry.group, entry.weight)), np.float64)
        groups, weights = pairs[0::2].astype(np.int64), pairs[1::2].astype(np.float32)
        # A group that is no more has the index of none.
        joints = joint_of[np.minimum(groups, len(joint_of) - 1)]
        owner = np.repeat(np.arange(self.count), counts)
        kept = (joints >= 0) & (weights > 0)
        self.joints, self.weights = joints[kept], weights[kept]
        self.starts = np.concatenate([[0], np.cumsum(np.bincount(owner[kept], minlength=self.count))])

    def parts(self):
        """A part for each material, as glTF has primitives: its material, the split vertices that it has, its triangles."""
        for material in np.unique(self.materials):
            used, triangles = np.unique(self.triangles[self.materials == material], return_inverse=True)
            yield int(material), used, triangles.reshape(-1, 3)

    def rows(self, vertices):
        """The weights of some vertices: joints, weights, starts."""
        counts = np.diff(self.starts)[vertices]
        starts = np.concatenate([[0], np.cumsum(counts)])
        take = np.repeat(self.starts[vertices], counts) + np.arange(starts[-1]) - np.repeat(starts[:-1], counts)
        return self.joints[take], self.weights[take], starts


def grey_of(material):
    """How bright the base colour texture of a material is, the row of v = 0 of glTF first; None where it has none."""
    if not material or not material.node_tree:
        return None
    nodes = material.node_tree.nodes
    shader = next((node for node in nodes if node.type == "BSDF_PRINCIPLED"), None)
    todo = [link.from_node for link in shader.inputs["Base Color"].links] if shader else list(nodes)
    seen, image = set(), None
    while todo and image is None:
        node = todo.pop()
        if node.name in seen:
            continue
        seen.add(node.name)
        image = node.image if node.type == "TEX_IMAGE" else None
        todo += [link.from_node for socket in node.inputs for link in socket.links]
    if image is None or not all(image.size):
        return None
    width, height = image.size
    colours = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(colours)
    colours = colours.reshape(height, width, 4)[::-1, :, :3]
    colours = np.clip(np.rint(colours * 255), 0, 255).astype(np.uint32)
    # The shares that SdefImage asks for.
    return ((colours @ np.array([54, 183, 19], np.uint32)) >> 8).astype(np.uint8)
