namespace SuperDeform
{
/// <summary>How a call of the library ended: the numbers of SDEF_STATUS_*.</summary>
public enum Status : uint
{
    /// <summary>Done.</summary>
    Ok = 0,
    /// <summary>A null, size or constant that cannot be: an error in the calling code.</summary>
    BadArgument = 1,
    /// <summary>The object is none, was disposed of, or is of another kind.</summary>
    BadHandle = 2,
    /// <summary>A number in an array is wrong: an index, a position that is not finite.</summary>
    BadInput = 3,
    /// <summary>An option is out of its range.</summary>
    BadOption = 4,
    /// <summary>A style cannot be read, or lacks what the mode transfers.</summary>
    BadStyle = 5,
    /// <summary>No joints for hips, head, upper legs and upper arms.</summary>
    NoHumanoid = 6,
    /// <summary>There are no triangles, or they have no extent along up.</summary>
    NoGeometry = 7,
    /// <summary>An array is too small.</summary>
    BufferTooSmall = 8,
    /// <summary>The object is in use, by another thread or by the call around this one.</summary>
    Busy = 9,
    /// <summary>The progress handler asked to stop.</summary>
    Cancelled = 10,
    /// <summary>Memory for the given arrays could not be had.</summary>
    OutOfMemory = 11,
    /// <summary>A fault of the library; the program goes on. Please report it with the message.</summary>
    Internal = 12,
}
}
