// What keeps the package out of players, and what is said where the library cannot be loaded or linked.
using System;
using System.Text;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.Build;
using UnityStubs;

namespace SuperDeform.Editor.Tests
{
    [TestFixture]
    public class PlayerTests
    {
        [SetUp]
        public void Begin()
        {
            Models.NewProject();
            foreach (BuildTargetGroup group in Enum.GetValues(typeof(BuildTargetGroup)))
            {
                PlayerSettings.SetScriptingDefineSymbols(NamedBuildTarget.FromBuildTargetGroup(group), "");
            }
        }

        static void Build(BuildTarget target)
        {
            new RuntimeLibrary().OnPreprocessBuild(StubBuild.Of(target));
        }

        [Test]
        public void a_build_needs_no_library_until_the_define_asks_for_one()
        {
            foreach (BuildTarget target in Enum.GetValues(typeof(BuildTarget))) Build(target);
        }

        [Test]
        public void the_define_asks_for_the_library_of_each_system()
        {
            foreach (BuildTarget target in Enum.GetValues(typeof(BuildTarget)))
            {
                NamedBuildTarget named = NamedBuildTarget.FromBuildTargetGroup(BuildPipeline.GetBuildTargetGroup(target));
                PlayerSettings.SetScriptingDefineSymbols(named, "OTHER;SUPERDEFORM_RUNTIME");
                BuildTarget one = target;
                var refused = Assert.Throws<BuildFailedException>(() => Build(one));
                string file = target == BuildTarget.iOS || target == BuildTarget.WebGL ? "libsuperdeform.a"
                    : target.ToString().Contains("Windows") ? "superdeform.dll"
                    : target == BuildTarget.StandaloneOSX ? "libsuperdeform.dylib" : "libsuperdeform.so";
                StringAssert.Contains(file, refused.Message);
                StringAssert.Contains(target.ToString(), refused.Message);
                StubBuild.AddPlugin(target, "Assets/Plugins/" + file);
                Build(target);
            }
        }

        [Test]
        public void a_library_too_new_for_the_system_gets_its_own_sentence()
        {
            byte[] library = Encoding.ASCII.GetBytes("\x7f" + "ELF\0GLIBC_2.9\0GLIBC_2.34\0GLIBC_2.17\0GLIBC_PRIVATE\0");
            Assert.AreEqual(new Version(2, 34), LibraryFile.Needed(library));
            Finding finding = LibraryFile.TooNew(library, new Version(2, 31));
            Assert.AreEqual("library_too_new", finding.Key);
            StringAssert.Contains("2.34", finding.Text);
            StringAssert.Contains("2.31", finding.Text);
            Assert.That(LibraryFile.TooNew(library, new Version(2, 34)), Is.Null);
        }

        [Test]
        public void the_system_tells_its_glibc()
        {
            Version version = LibraryFile.SystemVersion();
            Assert.That(version, Is.Not.Null);
            Assert.That(version, Is.GreaterThan(new Version(2, 0)));
        }
    }
}
