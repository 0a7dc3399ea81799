// Unity.Collections.NativeArray over a managed array that is pinned when its address is asked for.
using System;
using System.Collections;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace Unity.Collections
{
    public enum Allocator { Invalid = 0, None = 1, Temp = 2, TempJob = 3, Persistent = 4, AudioKernel = 5 }
    public enum NativeArrayOptions { UninitializedMemory = 0, ClearMemory = 1 }

    public struct NativeArray<T> : IDisposable, IEnumerable<T>, IEquatable<NativeArray<T>> where T : struct
    {
        internal sealed class Store
        {
            public T[] Data;
            GCHandle m_Pin;
            public IntPtr Address { get { if (!m_Pin.IsAllocated) m_Pin = GCHandle.Alloc(Data, GCHandleType.Pinned); return m_Pin.AddrOfPinnedObject(); } }
            public void Free() { if (m_Pin.IsAllocated) m_Pin.Free(); Data = null; }
            ~Store() { if (m_Pin.IsAllocated) m_Pin.Free(); }
        }

        internal Store m_Store;
        internal int m_Start, m_Length;
        Allocator m_Allocator;

        public NativeArray(int length, Allocator allocator) : this(length, allocator, NativeArrayOptions.ClearMemory) { }
        public NativeArray(int length, Allocator allocator, NativeArrayOptions options) : this()
        {
            if (allocator <= Allocator.None) throw new ArgumentException("use Temp, TempJob or Persistent", "allocator");
            if (length < 0) throw new ArgumentOutOfRangeException("length", "the length must be 0 or more");
            Fill(new T[length], allocator);
        }
        public NativeArray(T[] array, Allocator allocator) : this()
        {
            if (array == null) throw new ArgumentNullException("array");
            if (allocator <= Allocator.None) throw new ArgumentException("use Temp, TempJob or Persistent", "allocator");
            Fill((T[])array.Clone(), allocator);
        }
        public NativeArray(NativeArray<T> array, Allocator allocator) : this(array.ToArray(), allocator) { }
        // A view of memory that belongs to an engine object.
        internal static NativeArray<T> View(T[] data) { NativeArray<T> view = new NativeArray<T>(); view.Fill(data, Allocator.None); return view; }
        void Fill(T[] data, Allocator allocator) { m_Store = new Store { Data = data }; m_Length = data.Length; m_Allocator = allocator; }

        internal T[] Data
        {
            get
            {
                if (m_Store == null) throw new NullReferenceException("this array was never allocated");
                if (m_Store.Data == null) throw new ObjectDisposedException("this array was disposed");
                return m_Store.Data;
            }
        }
        public int Length { get { return m_Length; } }
        public bool IsCreated { get { return m_Store != null && m_Store.Data != null; } }
        public T this[int index]
        {
            get { Inside(index); return Data[m_Start + index]; }
            set { Inside(index); Data[m_Start + index] = value; }
        }
        void Inside(int index) { if (index < 0 || index >= m_Length) throw new IndexOutOfRangeException("index " + index + " of " + m_Length + " elements"); }
        public void Dispose()
        {
            if (m_Store == null || m_Store.Data == null) throw new ObjectDisposedException("this array was disposed before or never allocated");
            if (m_Allocator > Allocator.None) m_Store.Free();
            m_Store = null; m_Length = 0;
        }
        public T[] ToArray() { T[] copy = new T[m_Length]; if (m_Length > 0) Array.Copy(Data, m_Start, copy, 0, m_Length); return copy; }
        public void CopyTo(T[] array) { Same(array.Length); Array.Copy(Data, m_Start, array, 0, m_Length); }
        public void CopyTo(NativeArray<T> array) { Same(array.Length); Array.Copy(Data, m_Start, array.Data, array.m_Start, m_Length); }
        public void CopyFrom(T[] array) { Same(array.Length); Array.Copy(array, 0, Data, m_Start, m_Length); }
        public void CopyFrom(NativeArray<T> array) { array.CopyTo(this); }
        void Same(int length) { if (length != m_Length) throw new ArgumentException(length + " elements for " + m_Length); }
        public static void Copy(NativeArray<T> source, NativeArray<T> destination) { source.CopyTo(destination); }
        public static void Copy(NativeArray<T> source, T[] destination) { source.CopyTo(destination); }
        public static void Copy(T[] source, NativeArray<T> destination) { destination.CopyFrom(source); }
        public static void Copy(NativeArray<T> source, int sourceIndex, T[] destination, int destinationIndex, int length) { Array.Copy(source.Data, source.m_Start + sourceIndex, destination, destinationIndex, length); }
        public static void Copy(T[] source, int sourceIndex, NativeArray<T> destination, int destinationIndex, int length) { Array.Copy(source, sourceIndex, destination.Data, destination.m_Start + destinationIndex, length); }
        public NativeArray<T> GetSubArray(int start, int length)
        {
            if (start < 0 || length < 0 || start + length > m_Length) throw new ArgumentOutOfRangeException("start", "elements " + start + " to " + (start + length - 1) + " of " + m_Length);
            NativeArray<T> part = this;
            part.m_Start += start; part.m_Length = length; part.m_Allocator = Allocator.None;
            return part;
        }
        public Enumerator GetEnumerator() { return new Enumerator(this); }
        IEnumerator<T> IEnumerable<T>.GetEnumerator() { return GetEnumerator(); }
        IEnumerator IEnumerable.GetEnumerator() { return GetEnumerator(); }
        public bool Equals(NativeArray<T> other) { return ReferenceEquals(m_Store, other.m_Store) && m_Start == other.m_Start && m_Length == other.m_Length; }
        public override bool Equals(object other) { return other is NativeArray<T> && Equals((NativeArray<T>)other); }
        public override int GetHashCode() { return m_Store == null ? 0 : m_Store.GetHashCode() ^ m_Length; }

        public struct Enumerator : IEnumerator<T>
        {
            readonly NativeArray<T> m_Array;
            int m_At;
            internal Enumerator(NativeArray<T> array) { m_Array = array; m_At = -1; }
            public T Current { get { return m_Array[m_At]; } }
            object IEnumerator.Current { get { return Current; } }
            public bool MoveNext() { return ++m_At < m_Array.Length; }
            public void Reset() { m_At = -1; }
            public void Dispose() { }
        }
    }
}

namespace Unity.Collections.LowLevel.Unsafe
{
    public static class NativeArrayUnsafeUtility
    {
        public static unsafe void* GetUnsafePtr<T>(this NativeArray<T> array) where T : struct { return (byte*)array.m_Store.Address + array.m_Start * Marshal.SizeOf(typeof(T)); }
        public static unsafe void* GetUnsafeReadOnlyPtr<T>(this NativeArray<T> array) where T : struct { return GetUnsafePtr(array); }
    }
}
