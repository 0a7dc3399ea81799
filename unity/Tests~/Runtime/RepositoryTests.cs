using System;
using System.IO;
using System.Text.RegularExpressions;
using NUnit.Framework;

namespace SuperDeform.Tests
{
/// <summary>What the runtime says of the repository that it comes from, named by SUPERDEFORM_REPOSITORY.</summary>
[TestFixture]
public sealed class RepositoryTests
{
    [Test]
    public void The_version_is_the_librarys_and_the_packages()
    {
        string library = Regex.Match(Read("Cargo.toml"), "^version = \"(.*)\"", RegexOptions.Multiline).Groups[1].Value;
        Assert.AreEqual(library, SuperDeformLibrary.Version);
        string package = Regex.Match(Read("unity/package.json"), "\"version\": *\"(.*)\"").Groups[1].Value;
        Assert.AreEqual(package, SuperDeformLibrary.Version);
    }

    [Test]
    public void The_command_that_builds_the_library_is_there()
    {
        string[] words = SuperDeformLibrary.BuildCommand.Split(' ');
        Assert.AreEqual(3, words.Length);
        StringAssert.Contains(words[2], Read(words[1]));
    }

    [Test]
    public void The_version_of_the_interface_is_the_headers()
    {
        StringAssert.Contains("#define SDEF_ABI_VERSION " + Native.SDEF_ABI_VERSION, Read("include/superdeform.h"));
    }

    static string Read(string path)
    {
        return File.ReadAllText(Path.Combine(Environment.GetEnvironmentVariable("SUPERDEFORM_REPOSITORY"), path));
    }
}
}
