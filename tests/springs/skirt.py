#!/usr/bin/env python3
"""skirt.py IN.vrm OUT.vrm: hangs the skirt of a VRM 1.0 avatar from eight chains of springs, with a capsule around each leg.

For springs.mjs: no avatar with a free licence has such a skirt. The skirt is the mesh whose name holds "skirt"; joints must rest
unturned, as VRM 1.0 avatars out of MakeHuman do.
"""
import json, math, struct, sys

CHAINS, LEVELS = 8, 4


def read(path):
    data = open(path, 'rb').read()
    length = struct.unpack_from('<I', data, 12)[0]
    return json.loads(data[20:20 + length]), bytearray(data[28 + length:])


def write(path, document, binary):
    document['buffers'][0]['byteLength'] = len(binary)
    text = json.dumps(document).encode()
    text += b' ' * (-len(text) % 4)
    binary += b'\0' * (-len(binary) % 4)
    total = 28 + len(text) + len(binary)
    open(path, 'wb').write(b'glTF' + struct.pack('<III', 2, total, len(text)) + b'JSON' + text
                           + struct.pack('<I', len(binary)) + b'BIN\0' + binary)


def floats(document, binary, accessor, width):
    accessor = document['accessors'][accessor]
    view = document['bufferViews'][accessor['bufferView']]
    start = view.get('byteOffset', 0) + accessor.get('byteOffset', 0)
    stride = view.get('byteStride', 4 * width)
    return [struct.unpack_from(f'<{width}f', binary, start + row * stride) for row in range(accessor['count'])]


def add(document, binary, rows, kind, code, component):
    binary += b'\0' * (-len(binary) % 8)
    start = len(binary)
    for row in rows:
        binary += struct.pack(f'<{len(row)}{code}', *row)
    document['bufferViews'].append({'buffer': 0, 'byteOffset': start, 'byteLength': len(binary) - start})
    document['accessors'].append({'bufferView': len(document['bufferViews']) - 1, 'componentType': component,
                                  'type': kind, 'count': len(rows)})
    return len(document['accessors']) - 1


def main():
    document, binary = read(sys.argv[1])
    nodes = document['nodes']
    parent = {child: index for index, node in enumerate(nodes) for child in node.get('children', [])}

    def place(node):
        at = [0.0, 0.0, 0.0]
        while node is not None:
            assert nodes[node].get('rotation', [0, 0, 0, 1]) == [0, 0, 0, 1], 'a joint rests turned'
            at = [a + b for a, b in zip(at, nodes[node].get('translation', [0, 0, 0]))]
            node = parent.get(node)
        return at

    shown = next(node for node in nodes if 'mesh' in node and 'skirt' in document['meshes'][node['mesh']].get('name', node.get('name', '')))
    skin, primitive = document['skins'][shown['skin']], document['meshes'][shown['mesh']]['primitives'][0]
    points = floats(document, binary, primitive['attributes']['POSITION'], 3)
    binds = floats(document, binary, skin['inverseBindMatrices'], 16)
    bones = document['extensions']['VRMC_vrm']['humanoid']['humanBones']
    hips = bones['hips']['node']
    low, high = min(p[1] for p in points), max(p[1] for p in points)
    middle = [sum(p[axis] for p in points) / len(points) for axis in (0, 2)]

    def at(chain, level):
        angle, height = 2 * math.pi * chain / CHAINS, high + (low - high) * level / LEVELS
        near = sorted(points, key=lambda p: abs(p[1] - height) + 2 * abs(math.remainder(
            math.atan2(p[0] - middle[0], p[2] - middle[1]) - angle, 2 * math.pi)))[0]
        radius = math.hypot(near[0] - middle[0], near[2] - middle[1])
        return [middle[0] + radius * math.sin(angle), height, middle[1] + radius * math.cos(angle)]

    first, springs = len(skin['joints']), []
    for chain in range(CHAINS):
        above, from_, chain_nodes = hips, place(hips), []
        for level in range(LEVELS + 1):
            p = at(chain, level)
            nodes.append({'name': f'skirt {chain} {level}', 'translation': [a - b for a, b in zip(p, from_)]})
            nodes[above].setdefault('children', []).append(len(nodes) - 1)
            above, from_ = len(nodes) - 1, p
            chain_nodes.append(above)
            skin['joints'].append(above)
            binds.append((1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -p[0], -p[1], -p[2], 1))
        joints = [{'node': node, 'hitRadius': 0.01, 'stiffness': 1, 'gravityPower': 0.1, 'dragForce': 0.4} for node in chain_nodes]
        springs.append({'name': f'skirt {chain}', 'joints': joints, 'colliderGroups': [0]})
    indices, weights = [], []
    for p in points:
        around = math.atan2(p[0] - middle[0], p[2] - middle[1]) / (2 * math.pi) * CHAINS % CHAINS
        down = min(max((high - p[1]) / (high - low) * LEVELS, 0), LEVELS - 1e-6)
        column, level, aside, below = int(around) % CHAINS, int(down), around % 1, down % 1
        joint = lambda chain, level: first + (chain % CHAINS) * (LEVELS + 1) + level
        indices.append((joint(column, level), joint(column + 1, level), joint(column, level + 1), joint(column + 1, level + 1)))
        weights.append(((1 - aside) * (1 - below), aside * (1 - below), (1 - aside) * below, aside * below))
    primitive['attributes']['JOINTS_0'] = add(document, binary, indices, 'VEC4', 'H', 5123)
    primitive['attributes']['WEIGHTS_0'] = add(document, binary, weights, 'VEC4', 'f', 5126)
    skin['inverseBindMatrices'] = add(document, binary, binds, 'MAT4', 'f', 5126)
    colliders = []
    for side in ('left', 'right'):
        upper, lower = (bones[f'{side}{part}']['node'] for part in ('UpperLeg', 'LowerLeg'))
        tail = [b - a for a, b in zip(place(upper), place(lower))]
        colliders.append({'node': upper, 'shape': {'capsule': {'offset': [0, 0, 0], 'tail': tail, 'radius': 0.075}}})
    document['extensionsUsed'] = sorted({*document.get('extensionsUsed', []), 'VRMC_springBone'})
    document['extensions']['VRMC_springBone'] = {
        'specVersion': '1.0', 'colliders': colliders, 'colliderGroups': [{'name': 'legs', 'colliders': [0, 1]}], 'springs': springs,
    }
    write(sys.argv[2], document, binary)


main()
