using System.Collections.Generic;

namespace SuperDeform.Editor
{
    /// <summary>What a preview measured.</summary>
    public sealed class PreviewNumbers
    {
        public Report Report;
        public Group[] Groups;
        public IList<Warning> Warnings;
    }
}
