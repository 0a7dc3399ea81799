using System;
using NUnit.Framework;

namespace SuperDeform.Tests
{
/// <summary>What calls throw.</summary>
public static class Thrown
{
    /// <summary>The exception of a call that must fail with this status.</summary>
    public static T With<T>(Status status, Action call) where T : SuperDeformException
    {
        try
        {
            call();
        }
        catch (T exception)
        {
            Assert.AreEqual(status, exception.Status, exception.Message);
            Assert.AreEqual(typeof(T), exception.GetType());
            Assert.IsTrue(exception.Message.Length > 20, "no sentence: '" + exception.Message + "'");
            return exception;
        }
        Assert.Fail("nothing was thrown, but " + typeof(T).Name + " was expected");
        return null;
    }

    public static InvalidInputException Invalid(Status status, Action call) => With<InvalidInputException>(status, call);

    /// <summary>Checks that a sentence holds words.</summary>
    public static void Says(Exception exception, params string[] words)
    {
        foreach (string word in words)
        {
            Assert.IsTrue(exception.Message.Contains(word), "'" + word + "' is not in: " + exception.Message);
        }
    }
}
}
