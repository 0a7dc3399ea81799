using System.Collections.Generic;
using System.Text;

namespace SuperDeform.Editor
{
    /// <summary>What became of one avatar of a batch.</summary>
    public sealed class BatchEntry
    {
        /// <summary>Path of the avatar's prefab, or its name where it has none.</summary>
        public string Avatar;
        /// <summary>What was made; null where it failed.</summary>
        public ConversionResult Result;
        /// <summary>Why it failed, in one sentence; null where it did not.</summary>
        public string Failure;
    }

    /// <summary>What became of a batch.</summary>
    public sealed class BatchReport
    {
        public List<BatchEntry> Entries = new List<BatchEntry>();
        /// <summary>Whether a person stopped it; avatars after that have no entry.</summary>
        public bool Cancelled;

        public int Converted => Entries.FindAll(entry => entry.Failure == null).Count;
        public int Failed => Entries.FindAll(entry => entry.Failure != null).Count;

        /// <summary>What a person should read: a line an avatar, a line a finding, and a summary.</summary>
        public List<string> Lines()
        {
            var lines = new List<string>();
            foreach (BatchEntry entry in Entries)
            {
                if (entry.Failure != null)
                {
                    lines.Add(Strings.Get("batch.failed", entry.Avatar, entry.Failure));
                    continue;
                }
                Report report = entry.Result.Report;
                lines.Add(Strings.Get("batch.done", entry.Avatar, report.Target.Heads.ToString("0.0", Invariant),
                    report.Result.Heads.ToString("0.0", Invariant), entry.Result.PrefabPath));
                if (entry.Result.Findings != null)
                {
                    foreach (Finding finding in entry.Result.Findings)
                    {
                        lines.Add(Strings.Get("batch.warned", entry.Avatar, finding.Text));
                    }
                }
            }
            lines.Add(Strings.Get("batch.summary", Converted, Failed));
            return lines;
        }

        /// <summary>The same as JSON: converted, failed, cancelled, and an array of avatars, each with its prefab and the
        /// library's report, or with its error.</summary>
        public string ToJson()
        {
            var text = new StringBuilder();
            text.AppendFormat(Invariant, "{{\"converted\": {0}, \"failed\": {1}, \"cancelled\": {2}, \"avatars\": [",
                Converted, Failed, Cancelled ? "true" : "false");
            for (int i = 0; i < Entries.Count; i++)
            {
                BatchEntry entry = Entries[i];
                text.Append(i == 0 ? "\n" : ",\n").Append("{\"avatar\": ").Append(FlatJson.Quote(entry.Avatar));
                if (entry.Failure != null) text.Append(", \"error\": ").Append(FlatJson.Quote(entry.Failure));
                else
                {
                    text.Append(", \"prefab\": ").Append(FlatJson.Quote(entry.Result.PrefabPath)).Append(", \"report\": ")
                        .Append(string.IsNullOrEmpty(entry.Result.ReportJson) ? "null" : entry.Result.ReportJson);
                }
                text.Append('}');
            }
            return text.Append("\n]}\n").ToString();
        }

        static readonly System.Globalization.CultureInfo Invariant =
            System.Globalization.CultureInfo.InvariantCulture;
    }
}
