// System.Collections.Immutable, which NDMF brings along: as much of it as NDMF's preview has in its signatures.
using System.Collections.Generic;

namespace System.Collections.Immutable
{
    public sealed class ImmutableList<T> : IReadOnlyList<T>
    {
        readonly List<T> m_Items;
        internal ImmutableList(IEnumerable<T> items) { m_Items = new List<T>(items); }
        public int Count { get { return m_Items.Count; } }
        public T this[int index] { get { return m_Items[index]; } }
        public IEnumerator<T> GetEnumerator() { return m_Items.GetEnumerator(); }
        IEnumerator IEnumerable.GetEnumerator() { return GetEnumerator(); }
    }

    public static class ImmutableList
    {
        public static ImmutableList<T> ToImmutableList<T>(this IEnumerable<T> source) { return new ImmutableList<T>(source); }
    }
}
