// Writes a file anew in which no two primitives share vertices, and none has vertices that it does not use.
//
// Where primitives name the same accessors, each comes with all vertices of its neighbours too; an importer that makes one Mesh of
// them gives each vertex to the primitive that draws it. Both see the same parts in a file without such sharing.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Text;
using UnityStubs;

namespace SuperDeform.Tests.Glb
{
    public static class OwnVertices
    {
        public static void Write(string from, string to)
        {
            byte[] bytes = File.ReadAllBytes(from);
            int jsonLength = BitConverter.ToInt32(bytes, 12);
            Dictionary<string, object> root = (Dictionary<string, object>)JsonText.Parse(Encoding.UTF8.GetString(bytes, 20, jsonLength));
            List<byte> binary = new List<byte>(bytes.Length);
            for (int at = 28 + jsonLength; at < bytes.Length; at++) binary.Add(bytes[at]);
            GlbFile file = new GlbFile(from);
            foreach (object mesh in (List<object>)root["meshes"])
            {
                List<object> primitives = (List<object>)((Dictionary<string, object>)mesh)["primitives"];
                if (primitives.Count < 2) continue;
                foreach (Dictionary<string, object> primitive in primitives) Separate(root, file, primitive, binary);
            }
            while (binary.Count % 4 != 0) binary.Add(0);
            ((Dictionary<string, object>)((List<object>)root["buffers"])[0])["byteLength"] = (double)binary.Count;
            StringBuilder text = new StringBuilder();
            Append(text, root);
            List<byte> json = new List<byte>(Encoding.UTF8.GetBytes(text.ToString()));
            while (json.Count % 4 != 0) json.Add((byte)' ');
            using (BinaryWriter writer = new BinaryWriter(File.Create(to)))
            {
                writer.Write(0x46546C67u); writer.Write(2u); writer.Write((uint)(28 + json.Count + binary.Count));
                writer.Write((uint)json.Count); writer.Write(0x4E4F534Au); writer.Write(json.ToArray());
                writer.Write((uint)binary.Count); writer.Write(0x004E4942u); writer.Write(binary.ToArray());
            }
        }

        static void Separate(Dictionary<string, object> root, GlbFile file, Dictionary<string, object> primitive, List<byte> binary)
        {
            if (primitive.ContainsKey("targets")) throw new NotSupportedException("primitives with morph targets that share vertices");
            int[] corners = file.Integers((int)(double)primitive["indices"]);
            int[] used = new List<int>(new SortedSet<int>(corners)).ToArray();
            Dictionary<string, object> attributes = (Dictionary<string, object>)primitive["attributes"];
            foreach (string key in new List<string>(attributes.Keys))
            {
                int old = (int)(double)attributes[key];
                byte[] elements = file.Elements(old, used);
                Dictionary<string, object> told = new Dictionary<string, object>((Dictionary<string, object>)((List<object>)root["accessors"])[old]);
                if (key == "POSITION") Bound(told, file, old, used);
                attributes[key] = Accessor(root, binary, told, elements, used.Length, 34962);
            }
            byte[] indices = new byte[corners.Length * 4];
            for (int at = 0; at < corners.Length; at++) BitConverter.GetBytes(Array.BinarySearch(used, corners[at])).CopyTo(indices, at * 4);
            Dictionary<string, object> list = new Dictionary<string, object> { { "componentType", 5125.0 }, { "type", "SCALAR" } };
            primitive["indices"] = Accessor(root, binary, list, indices, corners.Length, 34963);
        }

        static void Bound(Dictionary<string, object> told, GlbFile file, int accessor, int[] used)
        {
            int components;
            double[] numbers = file.Numbers(accessor, out components);
            List<object> low = new List<object>(), high = new List<object>();
            for (int axis = 0; axis < 3; axis++)
            {
                double least = double.MaxValue, most = double.MinValue;
                foreach (int vertex in used) { least = Math.Min(least, numbers[vertex * 3 + axis]); most = Math.Max(most, numbers[vertex * 3 + axis]); }
                low.Add(least); high.Add(most);
            }
            told["min"] = low; told["max"] = high;
        }

        static double Accessor(Dictionary<string, object> root, List<byte> binary, Dictionary<string, object> told, byte[] elements, int count, int target)
        {
            while (binary.Count % 4 != 0) binary.Add(0);
            List<object> views = (List<object>)root["bufferViews"], accessors = (List<object>)root["accessors"];
            views.Add(new Dictionary<string, object> { { "buffer", 0.0 }, { "byteOffset", (double)binary.Count }, { "byteLength", (double)elements.Length }, { "target", (double)target } });
            binary.AddRange(elements);
            told["bufferView"] = (double)(views.Count - 1);
            told["byteOffset"] = 0.0;
            told["count"] = (double)count;
            accessors.Add(told);
            return accessors.Count - 1;
        }

        static void Append(StringBuilder text, object value)
        {
            Dictionary<string, object> members = value as Dictionary<string, object>;
            List<object> items = value as List<object>;
            if (members != null)
            {
                text.Append('{');
                bool first = true;
                foreach (KeyValuePair<string, object> pair in members) { if (!first) text.Append(','); first = false; JsonText.Quote(text, pair.Key); text.Append(':'); Append(text, pair.Value); }
                text.Append('}');
            }
            else if (items != null)
            {
                text.Append('[');
                for (int at = 0; at < items.Count; at++) { if (at > 0) text.Append(','); Append(text, items[at]); }
                text.Append(']');
            }
            else if (value is string) JsonText.Quote(text, (string)value);
            else if (value is double) text.Append(((double)value).ToString("R", CultureInfo.InvariantCulture));
            else if (value is bool) text.Append((bool)value ? "true" : "false");
            else text.Append("null");
        }
    }
}
