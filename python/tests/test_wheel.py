"""The installed wheel: its layout, its files against the command line's, its arrays, its errors."""

import ctypes
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import superdeform
from superdeform import abi
from superdeform.library import _library

ROOT = Path(__file__).resolve().parents[2]
ROGUE = ROOT / "tests" / "data" / "kaykit_rogue.glb"
# A box for each joint that is needed: role, joint, middle, half size.
BOXES = [
    ("hips", (0, 1, 0), (0, 1.2, 0), (0.15, 0.3, 0.1)), ("head", (0, 1.55, 0), (0, 1.67, 0), (0.1, 0.12, 0.1)),
    ("leftUpperArm", (0.2, 1.4, 0), (0.4, 1.4, 0), (0.25, 0.05, 0.05)), ("rightUpperArm", (-0.2, 1.4, 0), (-0.4, 1.4, 0), (0.25, 0.05, 0.05)),
    ("leftUpperLeg", (0.1, 0.8, 0), (0.1, 0.4, 0), (0.06, 0.4, 0.06)), ("rightUpperLeg", (-0.1, 0.8, 0), (-0.1, 0.4, 0), (0.06, 0.4, 0.06)),
]
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
TRIANGLES = [(corner[0], corner[at], corner[at + 1]) for corner in QUADS for at in (1, 2)]
CORNERS = np.array([[bits >> axis & 1 for axis in range(3)] for bits in range(8)]) * 2 - 1


def boxes():
    """A figure of six boxes, the head's with a morph target that lifts it by .1."""
    character = superdeform.Character()
    rest = np.tile(np.eye(4), (len(BOXES), 1, 1))
    rest[:, :3, 3] = [joint for _, joint, _, _ in BOXES]
    character.set_skeleton([-1] + [0] * 5, rest, roles={role: index for index, (role, *_) in enumerate(BOXES)})
    for index, (role, _, middle, half) in enumerate(BOXES):
        character.add_mesh(CORNERS * half + middle, TRIANGLES, role, joints=np.full((8, 1), index), weights=np.ones((8, 1)))
    character.add_morph_target(1, np.tile([0, 0.1, 0], (8, 1)), "up")
    return character


class Layout(unittest.TestCase):
    def test_structs_lie_as_c_compilers_lay_them(self):
        """cpp_tests/layout.inc is compiled in by every host in C and C++."""
        text = (ROOT / "cpp_tests" / "layout.inc").read_text()
        sizes, places = re.findall(r"^SIZE\((\w+), (\d+)\)", text, re.M), re.findall(r"^AT\((\w+), (\w+), (\d+)\)", text, re.M)
        self.assertGreater(len(places), 150)
        for name, size in sizes:
            self.assertEqual(ctypes.sizeof(getattr(abi, name)), int(size), name)
        for name, field, offset in places:
            self.assertEqual(getattr(getattr(abi, name), field).offset, int(offset), f"{name}.{field}")

    def test_every_function_is_there(self):
        header = (ROOT / "include" / "superdeform.h").read_text()
        self.assertEqual(set(abi.FUNCTIONS), set(re.findall(r"^SDEF_API .*?(sdef_\w+)\(", header, re.M)))
        for name in abi.FUNCTIONS:
            self.assertTrue(getattr(_library, name))


class Files(unittest.TestCase):
    def test_a_file_is_the_command_lines_to_the_byte(self):
        program = os.environ.get("SUPERDEFORM_EXAMPLE")
        if not program:
            self.skipTest("SUPERDEFORM_EXAMPLE names no command line to compare with")
        given = ROGUE.read_bytes()
        reference = ROOT / "tests" / "data" / "kaykit_rogue.glb"
        with tempfile.TemporaryDirectory() as folder:
            for arguments, asked in [(["--heads", "2.5"], {"heads": 2.5}), (["sd3", "--amount", "0.5"], {"style": "sd3", "amount": 0.5}),
                                     ([str(reference)], {"reference": reference.read_bytes()})]:
                out = Path(folder) / "out.glb"
                subprocess.run([program, str(ROGUE), *arguments, "-q", "-o", str(out)], check=True)
                self.assertEqual(superdeform.convert(given, **asked) == out.read_bytes(), True, arguments)

    def test_what_is_set_again_is_as_if_it_were_set_once(self):
        given = ROGUE.read_bytes()
        with superdeform.Conversion(given) as slid:
            for heads in (2.5, 3, 2):
                slid.set(heads=heads)
            file, report = slid.write()
        self.assertTrue(file == superdeform.convert(given, heads=2))
        self.assertLess(report["result"]["heads"], report["target"]["heads"])

    def test_faults_are_one_sentence(self):
        for given, asked, words in [(b"not a model", {}, "the file"), (ROGUE.read_bytes(), {"heads": 9}, "1.8 to 6"),
                                    (ROGUE.read_bytes(), {"amount": 2}, "0 to 1")]:
            with self.assertRaises(superdeform.Error) as fault:
                superdeform.convert(given, **asked)
            self.assertIn(words, str(fault.exception))
            self.assertNotIn("\n", str(fault.exception))
        with self.assertRaises(TypeError):
            superdeform.convert(b"", heads=2, style="sd3")
        with self.assertRaises(TypeError):
            superdeform.convert(ROGUE.read_bytes(), beauty=1)

    def test_progress_can_cancel(self):
        seen = []
        with self.assertRaises(superdeform.Error) as fault:
            superdeform.convert(ROGUE.read_bytes(), heads=2.5, progress=lambda part: seen.append(part) or len(seen) > 2)
        self.assertEqual((fault.exception.status, len(seen)), (abi.SDEF_STATUS_CANCELLED, 3))


class Arrays(unittest.TestCase):
    def test_amount_0_gives_the_character_back(self):
        deformer = superdeform.Deformer(boxes(), superdeform.Style.heads(3), amount=0)
        for mesh, (_, _, middle, half) in zip(deformer.apply(), BOXES):
            np.testing.assert_allclose(mesh.positions, CORNERS * half + middle, atol=1e-6)
        np.testing.assert_allclose(deformer.joints(), [joint for _, joint, _, _ in BOXES], atol=1e-6)

    def test_results_are_written_into_the_callers_arrays(self):
        deformer = superdeform.Deformer(boxes(), superdeform.Style.heads(3))
        room = deformer.room()
        addresses = [mesh.positions.ctypes.data for mesh in room]
        first = [mesh.positions.copy() for mesh in deformer.apply(room)]
        deformer.set_style(superdeform.Style.heads(2))
        self.assertIs(deformer.apply(room), room)
        self.assertEqual(addresses, [mesh.positions.ctypes.data for mesh in room])
        self.assertTrue(any(np.abs(mesh.positions - before).max() > 0.01 for mesh, before in zip(room, first)))

    def test_few_heads_are_few_heads(self):
        deformer = superdeform.Deformer(boxes(), superdeform.Style.heads(3))
        report = deformer.report()
        self.assertLess(report["result"]["heads"], report["target"]["heads"])
        head = deformer.apply()[1]
        # A rise at weight 1 is a rise of the head, as much larger as the head is along up.
        grown = np.ptp(head.positions[:, 1]) / (2 * BOXES[1][3][1])
        np.testing.assert_allclose(head.morphs[0][:, 1].mean(), 0.1 * grown, rtol=0.05)

    def test_a_saved_style_is_the_style(self):
        style = superdeform.Style.measure(boxes())
        again = superdeform.Style.text(style.json())
        self.assertEqual(style.json(), again.json())

    def test_wrong_arrays_are_refused(self):
        character = superdeform.Character()
        with self.assertRaises(ValueError):
            character.add_mesh([[0, 0]], TRIANGLES)
        with self.assertRaises(superdeform.Error) as fault:
            character.add_mesh(CORNERS[:4], TRIANGLES)
        self.assertEqual(fault.exception.status, abi.SDEF_STATUS_BAD_INPUT)
        # The first that uses a fifth vertex.
        self.assertEqual(fault.exception.element, 2)

    def test_what_is_closed_is_gone(self):
        before = _library.sdef_live_handles()
        with boxes() as character, superdeform.Style.heads(3) as style, superdeform.Deformer(character, style) as deformer:
            self.assertEqual(_library.sdef_live_handles(), before + 3)
        self.assertEqual(_library.sdef_live_handles(), before)
        with self.assertRaises(superdeform.Error) as fault:
            deformer.apply()
        self.assertEqual(fault.exception.status, abi.SDEF_STATUS_BAD_HANDLE)


if __name__ == "__main__":
    unittest.main()
