using System;
using System.Threading;
using NUnit.Framework;

namespace SuperDeform.Tests
{
[TestFixture]
public sealed class LifetimeTests
{
    readonly Mannequin figure = new Mannequin();

    [Test]
    public void A_thousand_forgotten_objects_are_collected()
    {
        Settle(0);
        ulong before = SuperDeformLibrary.LiveHandles;
        ulong most = 0;
        // On a thread of its own: nothing of its stack is left to keep them.
        var thread = new Thread(() => most = Forget());
        thread.Start();
        thread.Join();
        Assert.IsTrue(most > before, "none were made");
        Settle(before);
        // Mono takes each word on a stack for a reference, so a number that happens to be an object's address keeps it.
        bool guesses = Type.GetType("Mono.Runtime") != null;
        AtMost(before + (guesses ? 10UL : 0UL));
    }

    [Test]
    public void What_is_disposed_of_is_gone_at_once()
    {
        Settle(0);
        ulong before = SuperDeformLibrary.LiveHandles;
        using (Character character = figure.Character())
        using (Style style = Style.FromHeads(2.5))
        using (new Deformer(character, style))
        {
            AtMost(before + 3);
        }
        AtMost(before);
    }

    [Test]
    public void What_could_not_be_made_leaves_nothing()
    {
        Settle(0);
        ulong before = SuperDeformLibrary.LiveHandles;
        for (int i = 0; i < 20; i++)
        {
            Thrown.Invalid(Status.BadOption, () => Style.FromHeads(99));
            Thrown.Invalid(Status.BadInput, () => new Character(new float[3]));
        }
        AtMost(before);
    }

    [Test]
    public void Objects_are_disposed_of_once_by_any_number_of_threads()
    {
        Settle(0);
        ulong before = SuperDeformLibrary.LiveHandles;
        for (int time = 0; time < 50; time++)
        {
            var character = new Character();
            Thread[] threads = new Thread[3];
            for (int i = 0; i < threads.Length; i++)
            {
                threads[i] = new Thread(character.Dispose);
                threads[i].Start();
            }
            foreach (Thread thread in threads) thread.Join();
        }
        AtMost(before);
    }

    [Test]
    public void What_nobody_keeps_lives_as_long_as_its_call()
    {
        bool done = false;
        var collector = new Thread(() =>
        {
            while (!Volatile.Read(ref done)) GC.Collect();
        });
        collector.Start();
        try
        {
            for (int i = 0; i < 500; i++)
            {
                Assert.AreEqual(2.5, Style.FromText("sd2.5").Numbers.Heads, 1e-9);
                Assert.AreEqual(0, new Character().Info.MeshCount);
            }
        }
        finally
        {
            Volatile.Write(ref done, true);
            collector.Join();
        }
    }

    [Test]
    public void What_a_call_borrows_goes_back()
    {
        string name = new string('名', 1000000);
        StyleNumbers numbers;
        using (Style style = Style.FromText("sd3")) numbers = style.Numbers;
        // 3 MB of UTF-8 each time; what the runtime itself needs is settled after a few.
        long before = 0;
        for (int i = 0; i < 50; i++)
        {
            if (i == 10) before = Resident();
            Style.FromNumbers(name, numbers).Dispose();
            GC.Collect();
        }
        long grown = Resident() - before;
        Assert.IsTrue(grown < 60, grown + " MB more after 40 calls with 3 MB each");
    }

    static long Resident()
    {
        using (System.Diagnostics.Process self = System.Diagnostics.Process.GetCurrentProcess())
        {
            Assert.IsTrue(self.WorkingSet64 > 0, "this runtime does not tell how much memory it has");
            return self.WorkingSet64 >> 20;
        }
    }

    ulong Forget()
    {
        ulong most = 0;
        for (int i = 0; i < 480; i++)
        {
            Character character = figure.Character();
            Style style = Style.FromHeads(2.5);
            if (i % 12 == 0) GC.KeepAlive(new Deformer(character, style));
            most = Math.Max(most, SuperDeformLibrary.LiveHandles);
        }
        return most;
    }

    // No more handles than these: the finalizer may still take back what an earlier test forgot, at any time.
    static void AtMost(ulong handles)
    {
        ulong live = SuperDeformLibrary.LiveHandles;
        Assert.IsTrue(live <= handles, live + " handles live instead of " + handles);
    }

    // Collects until so few handles are left, or until it does not help.
    static void Settle(ulong wanted)
    {
        for (int i = 0; i < 10; i++)
        {
            GC.Collect();
            GC.WaitForPendingFinalizers();
            if (wanted > 0 && SuperDeformLibrary.LiveHandles <= wanted) return;
        }
    }
}
}
