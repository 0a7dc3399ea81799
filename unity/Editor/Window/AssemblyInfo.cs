using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("SuperDeform.Editor.Ndmf")]
[assembly: InternalsVisibleTo("SuperDeform.Editor.Tests")]
[assembly: InternalsVisibleTo("PreviewBench")]
