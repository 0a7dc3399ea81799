using System;
using System.Text;

namespace SuperDeform
{
/// <summary>Text from and for the library: UTF-8, NUL-terminated.</summary>
internal static unsafe class Text
{
    internal delegate uint Call(sbyte* text, UIntPtr capacity, UIntPtr* size, SdefError* error);

    /// <summary>A terminated text; null for null.</summary>
    internal static string Of(sbyte* text)
    {
        if (text == null) return null;
        int length = 0;
        while (text[length] != 0) length++;
        return Encoding.UTF8.GetString((byte*)text, length);
    }

    /// <summary>Text of a function that tells how much room it needs.</summary>
    internal static string Read(Call call)
    {
        byte[] room = new byte[0];
        for (;;)
        {
            UIntPtr size = UIntPtr.Zero;
            SdefError error = Failure.None();
            uint status;
            fixed (byte* text = room)
            {
                status = call((sbyte*)text, (UIntPtr)(uint)room.Length, &size, &error);
            }
            // What it writes of may grow between the question and the answer.
            bool grew = status == Native.SDEF_STATUS_BUFFER_TOO_SMALL || status == Native.SDEF_STATUS_OK;
            if (grew && (ulong)size > (ulong)room.Length)
            {
                room = new byte[checked((int)size)];
                continue;
            }
            Failure.Check(status, &error);
            return size == UIntPtr.Zero ? "" : Encoding.UTF8.GetString(room, 0, (int)size - 1);
        }
    }
}
}
