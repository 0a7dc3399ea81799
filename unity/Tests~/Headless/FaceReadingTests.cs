// What is read of faces beside their meshes.
using NUnit.Framework;
using UnityEngine;
using VRC.SDK3.Avatars.Components;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class FaceReadingTests
    {
        static Transform Eye(ConversionFigure figure, string name, float aside)
        {
            Transform eye = new GameObject(name).transform;
            eye.SetParent(figure.Bones[HumanBodyBones.Head], false);
            eye.position = new Vector3(aside, 1.7f, 0.08f);
            return eye;
        }

        [Test]
        public void eye_bones_that_only_a_component_knows_get_their_roles()
        {
            Models.NewProject();
            ConversionFigure figure = new ConversionFigure().Make();
            Transform left = Eye(figure, "Orb_1", -0.03f), right = Eye(figure, "Orb_2", 0.03f);
            VRCAvatarDescriptor descriptor = figure.Root.AddComponent<VRCAvatarDescriptor>();
            descriptor.customEyeLookSettings.leftEye = left;
            using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions()))
            {
                Assert.AreEqual(HumanoidRole.None, data.Character.GetJoints().Roles[data.IndexOf(left)], "one eye is no pair");
            }
            descriptor.customEyeLookSettings.rightEye = right;
            using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions()))
            {
                HumanoidRole[] roles = data.Character.GetJoints().Roles;
                Assert.AreEqual(HumanoidRole.LeftEye, roles[data.IndexOf(left)]);
                Assert.AreEqual(HumanoidRole.RightEye, roles[data.IndexOf(right)]);
            }
        }

        [Test]
        public void what_materials_show_is_handed_over_once_and_seen_by_no_one_else()
        {
            Models.NewProject();
            ConversionFigure figure = new ConversionFigure().Make();
            Texture2D texture = new Texture2D(1024, 4);
            texture.SetPixels32(System.Array.ConvertAll(new byte[1024 * 4], nothing => new Color32(10, 200, 30, 255)));
            foreach (Material material in figure.Body.sharedMaterials) material.mainTexture = texture;
            Mesh mesh = figure.Body.sharedMesh;
            mesh.uv = new Vector2[mesh.vertexCount];
            using (AvatarData data = CharacterReader.Read(figure.Root, new ReadOptions()))
            {
                PartData skin = data.Parts.Find(part => part.Renderer.Renderer == figure.Body);
                Assert.AreEqual(figure.Body.sharedMaterials[0], skin.Material);
                // The two materials have shown one image, so the next one is the second.
                Assert.AreEqual(2, data.Character.AddImage(1, 1, new byte[1]));
            }
            Assert.IsNull(RenderTexture.active);
        }
    }
}
