# SPDX-License-Identifier: MIT OR Apache-2.0
"""Which bone plays which role: by the VRM add-on's tables where there are any, else left to the library, which knows names."""


def roles_of(armature, joint_of):
    """Joint by role, as VRM 1.0 names roles; empty where nobody says.

    - `joint_of`: joint by bone name.
    """
    extension = getattr(armature.data, "vrm_addon_extension", None)
    if extension is None:
        return {}
    if extension.spec_version == "1.0":
        bones = extension.vrm1.humanoid.human_bones.human_bone_name_to_human_bone()
        named = [(role.value, bone.node.bone_name) for role, bone in bones.items()]
    else:
        named = [(_modern(bone.bone), bone.node.bone_name) for bone in extension.vrm0.humanoid.human_bones]
    return {role: joint_of[bone] for role, bone in named if bone in joint_of}


def _modern(role):
    """A role of VRM 0.x as 1.0 calls it: the thumb's bones have other names."""
    if "Thumb" not in role:
        return role
    return role.replace("Proximal", "Metacarpal").replace("Intermediate", "Proximal")
