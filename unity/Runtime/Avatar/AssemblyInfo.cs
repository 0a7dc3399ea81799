using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("SuperDeform.Editor")]
[assembly: InternalsVisibleTo("SuperDeform.Editor.Tests")]
