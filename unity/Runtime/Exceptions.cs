using System;

namespace SuperDeform
{
/// <summary>
/// What the library refused or could not do. <see cref="Exception.Message"/> is one sentence that names the thing, the
/// element, the value and the remedy. Thrown itself for <see cref="SuperDeform.Status.BadHandle"/> and
/// <see cref="SuperDeform.Status.OutOfMemory"/>; each other status has a class below.
/// </summary>
public class SuperDeformException : Exception
{
    public SuperDeformException(Status status, string message, int mesh = -1, int element = -1, Exception inner = null)
        : base(message, inner)
    {
        Status = status;
        Mesh = mesh;
        Element = element;
    }

    /// <summary>How the call ended; never <see cref="SuperDeform.Status.Ok"/>.</summary>
    public Status Status { get; private set; }

    /// <summary>Index of the mesh concerned, or -1.</summary>
    public int Mesh { get; private set; }

    /// <summary>Index of the vertex, triangle or joint concerned, or -1.</summary>
    public int Element { get; private set; }
}

/// <summary>
/// Arrays, options or styles that cannot be: BadArgument, BadInput, BadOption, BadStyle, NoGeometry, BufferTooSmall.
/// </summary>
public sealed class InvalidInputException : SuperDeformException
{
    public InvalidInputException(Status status, string message, int mesh = -1, int element = -1)
        : base(status, message, mesh, element) { }
}

/// <summary>NoHumanoid: required joints are missing. Name them, or make a rig.</summary>
public sealed class NotHumanoidException : SuperDeformException
{
    public NotHumanoidException(string message, int mesh = -1, int element = -1)
        : base(Status.NoHumanoid, message, mesh, element) { }
}

/// <summary>Cancelled: the progress handler returned false. Everything is as it was before the call.</summary>
public sealed class CancelledException : SuperDeformException
{
    public CancelledException(string message) : base(Status.Cancelled, message) { }
}

/// <summary>Busy: another thread, or the call around this one, uses the object.</summary>
public sealed class BusyException : SuperDeformException
{
    public BusyException(string message) : base(Status.Busy, message) { }
}

/// <summary>Internal: a fault of the library. The program goes on; please report it with the message.</summary>
public sealed class LibraryFaultException : SuperDeformException
{
    public LibraryFaultException(string message, int mesh = -1, int element = -1)
        : base(Status.Internal, message, mesh, element) { }
}

/// <summary>
/// The native library is not there, or not for this machine; the message says where to get it. The status is Internal.
/// </summary>
public sealed class LibraryMissingException : SuperDeformException
{
    public LibraryMissingException(string message, Exception inner = null)
        : base(Status.Internal, message, -1, -1, inner) { }
}

/// <summary>
/// A native library of another version is loaded; the message says what to do. The status is Internal.
/// </summary>
public sealed class LibraryVersionException : SuperDeformException
{
    public LibraryVersionException(string message, Exception inner = null)
        : base(Status.Internal, message, -1, -1, inner) { }
}
}
