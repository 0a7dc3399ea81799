using System;
using System.Threading;

namespace SuperDeform
{
/// <summary>
/// The owner of an object of the native library. Dispose of it when done; what is forgotten goes with the garbage
/// collection. Any thread may do so at any time, during calls too.
/// </summary>
public abstract class NativeObject : IDisposable
{
    long handle;

    internal NativeObject()
    {
        SuperDeformLibrary.Check();
    }

    ~NativeObject()
    {
        Destroy();
    }

    public void Dispose()
    {
        Destroy();
        GC.SuppressFinalize(this);
    }

    /// <summary>Whether <see cref="Dispose"/> was called.</summary>
    public bool IsDisposed => Interlocked.Read(ref handle) == 0;

    /// <summary>
    /// The handle, for one call: GC.KeepAlive(this) comes after that, or the finaliser might run before it.
    /// </summary>
    internal ulong Handle
    {
        get
        {
            ulong id = unchecked((ulong)Interlocked.Read(ref handle));
            if (id == 0) throw new ObjectDisposedException(GetType().Name);
            return id;
        }
        set { Interlocked.Exchange(ref handle, unchecked((long)value)); }
    }

    // Never throws: the library takes handles that it does not know, too, and gives a status.
    unsafe void Destroy()
    {
        long id = Interlocked.Exchange(ref handle, 0);
        if (id != 0) Native.sdef_destroy(unchecked((ulong)id), null);
    }
}
}
