using System.Collections.Generic;
using NUnit.Framework;
using UniVRM10;
using UnityEditor;
using UnityEngine;
using UnityStubs;
using VRM;

namespace SuperDeform.Editor.Tests
{
    /// <summary>An avatar whose licence forbids changes is asked about once, in every way to convert it.</summary>
    [TestFixture]
    public class LicenceTests
    {
        ConversionFigure figure;

        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            EditorPrefs.DeleteAll();
            Licences.Forget();
            figure = new ConversionFigure().Make();
        }

        [TearDown]
        public void End()
        {
            EditorPrefs.DeleteAll();
            Licences.Forget();
        }

        VRM10Object Vrm1(ModificationType modification, string address = null)
        {
            var asset = ScriptableObject.CreateInstance<VRM10Object>();
            asset.Meta.Modification = modification;
            asset.Meta.OtherLicenseUrl = address;
            AssetDatabase.CreateAsset(asset, AssetDatabase.GenerateUniqueAssetPath("Assets/Mika.asset"));
            figure.Root.AddComponent<Vrm10Instance>().Vrm = asset;
            return asset;
        }

        void Vrm0(LicenseType type, string address = null)
        {
            var asset = ScriptableObject.CreateInstance<VRMMetaObject>();
            asset.LicenseType = type;
            asset.OtherPermissionUrl = address;
            AssetDatabase.CreateAsset(asset, AssetDatabase.GenerateUniqueAssetPath("Assets/Meta.asset"));
            figure.Root.AddComponent<VRMMeta>().Meta = asset;
        }

        string Said()
        {
            List<Finding> found = AvatarChecks.Of(figure.Root).FindAll(finding => finding.Key.StartsWith("licence"));
            Assert.That(found.Count, Is.LessThan(2));
            return found.Count == 0 ? "" : found[0].Key + " " + found[0].Severity + " " + found[0].Values[1];
        }

        [Test]
        public void licences_of_vrm_1_say_it_in_words_or_by_an_address()
        {
            Assert.AreEqual("", Said(), "no VRM");
            Vrm1(ModificationType.prohibited);
            Assert.AreEqual("licence_prohibited Error prohibited", Said());
            Begin();
            Vrm1(ModificationType.allowModification);
            Assert.AreEqual("licence_not_to_share Warning allowModification", Said());
            Begin();
            Vrm1(ModificationType.allowModificationRedistribution);
            Assert.AreEqual("", Said());
            Begin();
            Vrm1(ModificationType.allowModification, "https://creativecommons.org/licenses/by-nd/4.0/");
            Assert.AreEqual("licence_prohibited Error https://creativecommons.org/licenses/by-nd/4.0/", Said(), "the strictest counts");
        }

        [Test]
        public void licences_of_vrm_0_say_it_by_name_or_by_an_address()
        {
            foreach (LicenseType type in System.Enum.GetValues(typeof(LicenseType)))
            {
                Begin();
                Vrm0(type);
                string wanted = type == LicenseType.CC_BY_ND || type == LicenseType.CC_BY_NC_ND ? "licence_prohibited Error " + type
                    : type == LicenseType.Redistribution_Prohibited ? "licence_not_to_share Warning " + type : "";
                Assert.AreEqual(wanted, Said(), type.ToString());
            }
            Begin();
            Vrm0(LicenseType.Other, "https://hub.vroid.com/en/license?allowed_to_use_user=everyone&modification=disallow&version=1");
            StringAssert.StartsWith("licence_prohibited", Said());
        }

        [Test]
        public void addresses()
        {
            const string hub = "https://hub.vroid.com/license?credit=necessary&";
            Assert.AreEqual(Licences.Changes.Prohibited, Licences.OfAddress(hub + "modification=disallow&redistribution=allow"));
            Assert.AreEqual(Licences.Changes.NotToShare, Licences.OfAddress(hub + "modification=allow&redistribution=disallow"));
            Assert.AreEqual(Licences.Changes.Allowed, Licences.OfAddress(hub + "modification=allow&redistribution=allow"));
            Assert.AreEqual(Licences.Changes.NotStated, Licences.OfAddress("https://hub.vroid.com/characters/1"));
            Assert.AreEqual(Licences.Changes.Prohibited, Licences.OfAddress(" https://www.creativecommons.org/licenses/by-nc-nd/4.0 "));
            Assert.AreEqual(Licences.Changes.Allowed, Licences.OfAddress("http://creativecommons.org/publicdomain/zero/1.0/"));
            Assert.AreEqual(Licences.Changes.Allowed, Licences.OfAddress("https://creativecommons.org/licenses/by/4.0/"));
            foreach (string other in new[] { "", "no address", "https://example.com/licenses/by-nd/", "https://creativecommons.org/" })
            {
                Assert.AreEqual(Licences.Changes.NotStated, Licences.OfAddress(other), other);
            }
        }

        [Test]
        public void the_window_asks_once()
        {
            VRM10Object asset = Vrm1(ModificationType.prohibited);
            ConverterWindow window = ConverterWindow.Open(figure.Root);
            Assert.That(window.Model.CanConvert, Is.False);
            var row = (CheckRow)window.Model.Sections[(int)SectionId.Avatar].Rows.Find(one => one is CheckRow && ((CheckRow)one).FixLabel == Strings.Get("fix_licence"));
            Assert.That(row, Is.Not.Null);
            row.Fix();
            Assert.That(window.Model.CanConvert);
            window.Close();
            // The same file's avatar, another time; and another file's.
            Assert.AreEqual("", Said());
            figure = new ConversionFigure().Make();
            figure.Root.AddComponent<Vrm10Instance>().Vrm = asset;
            Assert.AreEqual("", Said());
            figure = new ConversionFigure().Make();
            Vrm1(ModificationType.prohibited);
            StringAssert.StartsWith("licence_prohibited", Said());
        }

        [Test]
        public void the_menu_command_and_a_batch_refuse_until_somebody_says_so()
        {
            Vrm1(ModificationType.prohibited);
            var settings = new ConversionSettings { OutputFolder = "Assets/Out", PlaceInScene = false };
            BatchReport report = BatchConvert.Convert(new[] { figure.Root }, settings);
            Assert.AreEqual(1, report.Failed);
            StringAssert.Contains("does not allow changes (prohibited)", report.Entries[0].Failure);
            string path = "Assets/Mika.prefab";
            foreach (Renderer renderer in figure.Root.GetComponentsInChildren<Renderer>())
            {
                AssetDatabase.CreateAsset(Models.MeshOf(renderer), "Assets/" + renderer.name + "_mesh.asset");
            }
            AssetDatabase.CreateAsset(figure.Root.GetComponent<Animator>().avatar, "Assets/MikaAvatar.asset");
            PrefabUtility.SaveAsPrefabAsset(figure.Root, path);
            Assert.AreEqual(1, BatchConvert.Run(new[] { "-superdeformAvatars", path, "-superdeformAllowProhibited", "no" }));
            Assert.AreEqual(0, BatchConvert.Run(new[] { "-superdeformAvatars", path, "-superdeformAllowProhibited", "yes" }));
        }
    }
}
