using System.Collections.Generic;
using System.Collections.ObjectModel;

namespace SuperDeform
{
/// <summary>A warning about a rig, roles or a result.</summary>
public sealed class Warning
{
    Warning(string code, string text)
    {
        Code = code;
        Text = text;
    }

    /// <summary>A fixed word, such as joint_by_ratio.</summary>
    public string Code { get; private set; }

    /// <summary>One sentence.</summary>
    public string Text { get; private set; }

    public override string ToString() => Code + ": " + Text;

    internal static unsafe IList<Warning> Of(ulong handle)
    {
        return Parse(SuperDeform.Text.Read((text, capacity, size, error) =>
            Native.sdef_get_warnings(handle, text, capacity, size, error)));
    }

    // One "code: sentence" a line.
    internal static IList<Warning> Parse(string lines)
    {
        var warnings = new List<Warning>();
        foreach (string line in lines.Split('\n'))
        {
            if (line.Length == 0) continue;
            int colon = line.IndexOf(": ", System.StringComparison.Ordinal);
            warnings.Add(colon < 0
                ? new Warning("", line)
                : new Warning(line.Substring(0, colon), line.Substring(colon + 2)));
        }
        return new ReadOnlyCollection<Warning>(warnings);
    }
}
}
