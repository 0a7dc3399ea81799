using System;
using System.Runtime.InteropServices;
using System.Threading;

namespace SuperDeform
{
/// <summary>
/// A job system of the host's: calls the task once for every index below count, on any threads, beside each other or not,
/// and returns when all of these calls have returned.
/// </summary>
public delegate void JobRunner(int count, Action<int> task);

/// <summary>
/// Has a host's job system do the work of all calls that this thread makes until it is disposed of, in place of threads
/// of the library's own. Results are the same bits.
/// </summary>
/// <remarks>
/// Disposed of on the thread that made it, before scripts reload. What the runner leaves out, or throws before, is done
/// on the caller's thread; the exception comes out of Dispose.
/// </remarks>
public sealed unsafe class JobScope : IDisposable
{
    // Kept here, so that it is not collected while the library may call it.
    static readonly SdefJobs run = Run;

    readonly JobRunner runner;
    readonly Thread thread = Thread.CurrentThread;
    GCHandle self;
    Exception thrown;

    /// <param name="runner">Neither waits for another call of itself nor calls the library.</param>
    public JobScope(JobRunner runner)
    {
        if (runner == null) throw new ArgumentNullException("runner");
        SuperDeformLibrary.Check();
        this.runner = runner;
        self = GCHandle.Alloc(this);
        SdefError error = Failure.None();
        uint status = Native.sdef_set_jobs(run, (void*)GCHandle.ToIntPtr(self), &error);
        if (status != 0) self.Free();
        Failure.Check(status, &error);
    }

    /// <summary>Threads of the library's own do the work again.</summary>
    /// <exception cref="InvalidOperationException">This is another thread.</exception>
    public void Dispose()
    {
        if (!self.IsAllocated) return;
        if (Thread.CurrentThread != thread) throw new InvalidOperationException("A JobScope is disposed of on the thread that made it.");
        SdefError error = Failure.None();
        uint status = Native.sdef_set_jobs(null, null, &error);
        self.Free();
        Failure.Check(status, &error);
        if (thrown != null) throw thrown;
    }

    [MonoPInvokeCallback(typeof(SdefJobs))]
    static void Run(void* user, SdefTask task, void* data, uint count)
    {
        // No exception may cross the library, and every index must be done once.
        JobScope scope = (JobScope)GCHandle.FromIntPtr((IntPtr)user).Target;
        IntPtr handed = (IntPtr)data;
        int[] begun = new int[count];
        Action<int> once = index =>
        {
            if (Interlocked.Exchange(ref begun[index], 1) == 0) task((void*)handed, (uint)index);
        };
        try
        {
            scope.runner((int)count, once);
        }
        catch (Exception exception)
        {
            scope.thrown = exception;
        }
        for (int index = 0; index < begun.Length; index++) once(index);
    }
}
}
