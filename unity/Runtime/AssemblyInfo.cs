using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("SuperDeform.Tests")]
