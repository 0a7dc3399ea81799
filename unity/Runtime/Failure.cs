namespace SuperDeform
{
/// <summary>Errors of the library as exceptions.</summary>
internal static unsafe class Failure
{
    /// <summary>Room for an error.</summary>
    internal static SdefError None()
    {
        var error = new SdefError();
        error.struct_size = (uint)sizeof(SdefError);
        return error;
    }

    /// <summary>Throws what a call ended with, unless that is OK.</summary>
    internal static void Check(uint status, SdefError* error)
    {
        if (status == Native.SDEF_STATUS_OK) return;
        // SDEF_NONE is -1.
        throw Of((Status)status, Text.Of(error->message), unchecked((int)error->mesh), unchecked((int)error->element));
    }

    /// <summary>An error in the calling code that only this side of the library can see.</summary>
    internal static InvalidInputException Argument(string sentence) => new InvalidInputException(Status.BadArgument, sentence);

    internal static SuperDeformException Of(Status status, string message, int mesh, int element)
    {
        switch (status)
        {
            case Status.BadArgument:
            case Status.BadInput:
            case Status.BadOption:
            case Status.BadStyle:
            case Status.NoGeometry:
            case Status.BufferTooSmall:
                return new InvalidInputException(status, message, mesh, element);
            case Status.NoHumanoid:
                return new NotHumanoidException(message, mesh, element);
            case Status.Busy:
                return new BusyException(message);
            case Status.Cancelled:
                return new CancelledException(message);
            case Status.Internal:
                return new LibraryFaultException(message, mesh, element);
            default:
                return new SuperDeformException(status, message, mesh, element);
        }
    }
}
}
