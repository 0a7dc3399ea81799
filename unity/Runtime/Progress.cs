using System;
using System.Runtime.ExceptionServices;
using System.Runtime.InteropServices;

namespace SuperDeform
{
/// <summary>
/// Is called now and then, on the thread of the call that it was given to, with what part of the work is done: a
/// fraction that rises to 1. True goes on; false ends the call with a <see cref="CancelledException"/>, and so does an
/// exception, which then comes out of the call.
/// </summary>
public delegate bool ProgressHandler(float fraction);

/// <summary>A progress handler during one call of the library.</summary>
internal sealed unsafe class ProgressCall : IDisposable
{
    static readonly ProgressCall none = new ProgressCall(null);

    // Kept here, so that it is not collected while the library may call it.
    static readonly SdefProgress report = Report;

    readonly ProgressHandler handler;
    GCHandle self;
    ExceptionDispatchInfo thrown;

    ProgressCall(ProgressHandler handler)
    {
        this.handler = handler;
        if (handler != null) self = GCHandle.Alloc(this);
    }

    internal static ProgressCall Of(ProgressHandler handler) => handler == null ? none : new ProgressCall(handler);

    internal SdefProgress Callback => handler == null ? null : report;

    internal void* User => handler == null ? null : (void*)GCHandle.ToIntPtr(self);

    /// <summary>Throws what the handler threw; else what the call ended with.</summary>
    internal void Check(uint status, SdefError* error)
    {
        if (thrown != null) thrown.Throw();
        Failure.Check(status, error);
    }

    public void Dispose()
    {
        if (self.IsAllocated) self.Free();
    }

    [MonoPInvokeCallback(typeof(SdefProgress))]
    static int Report(void* user, float fraction)
    {
        // No exception may cross the library.
        ProgressCall call = null;
        try
        {
            call = (ProgressCall)GCHandle.FromIntPtr((IntPtr)user).Target;
            return call.handler(fraction) ? 0 : 1;
        }
        catch (Exception exception)
        {
            if (call != null) call.thrown = ExceptionDispatchInfo.Capture(exception);
            return 1;
        }
    }
}
}
