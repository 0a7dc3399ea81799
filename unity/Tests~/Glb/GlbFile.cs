// A GLB or VRM file: its JSON and the numbers of its accessors.
using System;
using System.Collections.Generic;
using System.IO;
using System.Text;
using UnityStubs;

namespace SuperDeform.Tests.Glb
{
    /// A JSON value with lookups that give null for what is not there.
    public struct Json
    {
        readonly object m_Value;
        public Json(object value) { m_Value = value; }
        public bool Exists { get { return m_Value != null; } }
        public Json this[string key]
        {
            get { Dictionary<string, object> members = m_Value as Dictionary<string, object>; object found; return new Json(members != null && members.TryGetValue(key, out found) ? found : null); }
        }
        public Json this[int index] { get { List<object> items = m_Value as List<object>; return new Json(items != null && index >= 0 && index < items.Count ? items[index] : null); } }
        public int Count { get { List<object> items = m_Value as List<object>; return items == null ? 0 : items.Count; } }
        public IEnumerable<Json> Items { get { for (int at = 0; at < Count; at++) yield return this[at]; } }
        public IEnumerable<string> Keys { get { Dictionary<string, object> members = m_Value as Dictionary<string, object>; return members == null ? (IEnumerable<string>)new string[0] : members.Keys; } }
        public int Int(int otherwise = -1) { return m_Value is double ? (int)(double)m_Value : otherwise; }
        public double Number(double otherwise = 0) { return m_Value is double ? (double)m_Value : otherwise; }
        public string Text(string otherwise = "") { return m_Value as string ?? otherwise; }
        public bool Bool() { return m_Value is bool && (bool)m_Value; }
        public float[] Floats() { float[] numbers = new float[Count]; for (int at = 0; at < numbers.Length; at++) numbers[at] = (float)this[at].Number(); return numbers; }
    }

    public sealed class GlbFile
    {
        public readonly string Name;
        public readonly Json Root;
        readonly byte[] m_Binary;

        public GlbFile(string path)
        {
            Name = Path.GetFileName(path);
            byte[] bytes = File.ReadAllBytes(path);
            if (bytes.Length < 20 || BitConverter.ToUInt32(bytes, 0) != 0x46546C67) throw new InvalidDataException(Name + " is no GLB file");
            m_Binary = new byte[0];
            for (int at = 12; at + 8 <= bytes.Length;)
            {
                int length = BitConverter.ToInt32(bytes, at);
                uint kind = BitConverter.ToUInt32(bytes, at + 4);
                if (kind == 0x4E4F534A) Root = new Json(JsonText.Parse(Encoding.UTF8.GetString(bytes, at + 8, length)));
                else if (kind == 0x004E4942 && m_Binary.Length == 0) { m_Binary = new byte[length]; Buffer.BlockCopy(bytes, at + 8, m_Binary, 0, length); }
                at += 8 + length;
            }
        }

        public bool IsVrm0 { get { return Root["extensions"]["VRM"].Exists; } }
        public bool IsVrm1 { get { return Root["extensions"]["VRMC_vrm"].Exists; } }

        static int Components(string type)
        {
            switch (type) { case "SCALAR": return 1; case "VEC2": return 2; case "VEC3": return 3; case "VEC4": return 4; case "MAT4": return 16; }
            throw new InvalidDataException("accessor type " + type);
        }

        /// All numbers of an accessor; whole numbers that stand for 0 to 1 come as that. Sparse replacements are made.
        public double[] Numbers(int accessor, out int components)
        {
            Json told = Root["accessors"][accessor];
            components = Components(told["type"].Text());
            int count = told["count"].Int(), type = told["componentType"].Int();
            double[] numbers = new double[count * components];
            if (told["bufferView"].Exists) Read(told["bufferView"].Int(), told["byteOffset"].Int(0), type, components, count, told["normalized"].Bool(), numbers);
            Json sparse = told["sparse"];
            if (!sparse.Exists) return numbers;
            int changed = sparse["count"].Int();
            double[] places = new double[changed], values = new double[changed * components];
            Read(sparse["indices"]["bufferView"].Int(), sparse["indices"]["byteOffset"].Int(0), sparse["indices"]["componentType"].Int(), 1, changed, false, places);
            Read(sparse["values"]["bufferView"].Int(), sparse["values"]["byteOffset"].Int(0), type, components, changed, told["normalized"].Bool(), values);
            for (int at = 0; at < changed; at++) Array.Copy(values, at * components, numbers, (int)places[at] * components, components);
            return numbers;
        }

        void Read(int viewIndex, int offset, int type, int components, int count, bool normalized, double[] into)
        {
            Json view = Root["bufferViews"][viewIndex];
            int size = type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 4;
            int start = view["byteOffset"].Int(0) + offset, stride = view["byteStride"].Int(0);
            if (stride == 0) stride = size * components;
            for (int element = 0; element < count; element++)
            {
                for (int component = 0; component < components; component++)
                {
                    int at = start + element * stride + component * size;
                    double number;
                    switch (type)
                    {
                        case 5120: number = (sbyte)m_Binary[at]; if (normalized) number = Math.Max(number / 127.0, -1.0); break;
                        case 5121: number = m_Binary[at]; if (normalized) number /= 255.0; break;
                        case 5122: number = BitConverter.ToInt16(m_Binary, at); if (normalized) number = Math.Max(number / 32767.0, -1.0); break;
                        case 5123: number = BitConverter.ToUInt16(m_Binary, at); if (normalized) number /= 65535.0; break;
                        case 5125: number = BitConverter.ToUInt32(m_Binary, at); break;
                        default: number = BitConverter.ToSingle(m_Binary, at); break;
                    }
                    into[element * components + component] = number;
                }
            }
        }

        /// The bytes of some elements of an accessor, packed.
        public byte[] Elements(int accessor, int[] which)
        {
            Json told = Root["accessors"][accessor], view = Root["bufferViews"][told["bufferView"].Int()];
            int type = told["componentType"].Int(), size = (type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 4) * Components(told["type"].Text());
            int start = view["byteOffset"].Int(0) + told["byteOffset"].Int(0), stride = view["byteStride"].Int(0);
            byte[] bytes = new byte[which.Length * size];
            for (int at = 0; at < which.Length; at++) Buffer.BlockCopy(m_Binary, start + which[at] * (stride == 0 ? size : stride), bytes, at * size, size);
            return bytes;
        }

        public int[] Integers(int accessor) { int components; return Array.ConvertAll(Numbers(accessor, out components), delegate (double number) { return (int)number; }); }
    }
}
