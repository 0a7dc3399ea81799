using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("SuperDeform.Editor.Tests")]
