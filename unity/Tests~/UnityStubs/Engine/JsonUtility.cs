// JsonUtility: the serialized fields of a plain class or ScriptableObject as JSON, by Unity's field rules.
using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.Reflection;
using System.Runtime.Serialization;
using System.Text;
using UnityStubs;

namespace UnityEngine
{
    public static class JsonUtility
    {
        public static string ToJson(object obj) { return ToJson(obj, false); }
        public static string ToJson(object obj, bool prettyPrint)
        {
            if (obj == null) return "";
            StringBuilder text = new StringBuilder();
            WriteFields(text, obj, obj.GetType());
            return text.ToString();
        }
        public static T FromJson<T>(string json) { return (T)FromJson(json, typeof(T)); }
        public static object FromJson(string json, Type type)
        {
            if (string.IsNullOrEmpty(json)) return null;
            if (typeof(Object).IsAssignableFrom(type)) throw new ArgumentException("a " + type.Name + " is not made from JSON: use FromJsonOverwrite");
            return Fill(type.IsValueType || type.GetConstructor(Type.EmptyTypes) != null ? Activator.CreateInstance(type) : FormatterServices.GetUninitializedObject(type), Parse(json));
        }
        public static void FromJsonOverwrite(string json, object objectToOverwrite) { if (!string.IsNullOrEmpty(json)) Fill(objectToOverwrite, Parse(json)); }

        static object Parse(string json)
        {
            try { return JsonText.Parse(json); }
            catch (FormatException fault) { throw new ArgumentException("JSON parse error: " + fault.Message); }
        }
        static void WriteFields(StringBuilder text, object obj, Type type)
        {
            text.Append('{');
            bool first = true;
            foreach (FieldInfo field in Fields.Of(type))
            {
                if (!first) text.Append(',');
                first = false;
                text.Append('"').Append(field.Name).Append("\":");
                Write(text, field.GetValue(obj), field.FieldType);
            }
            text.Append('}');
        }
        static void Write(StringBuilder text, object value, Type type)
        {
            if (type == typeof(string)) JsonText.Quote(text, (string)value ?? "");
            else if (typeof(Object).IsAssignableFrom(type)) text.Append("{\"instanceID\":").Append(value as Object == null ? 0 : ((Object)value).GetInstanceID()).Append('}');
            else if (type == typeof(bool)) text.Append((bool)value ? "true" : "false");
            else if (type.IsEnum) text.Append(Convert.ToInt64(value));
            else if (value is float) text.Append(((float)value).ToString("R", CultureInfo.InvariantCulture));
            else if (value is double) text.Append(((double)value).ToString("R", CultureInfo.InvariantCulture));
            else if (type.IsPrimitive) text.Append(Convert.ToString(value, CultureInfo.InvariantCulture));
            else if (type.IsArray || typeof(IList).IsAssignableFrom(type))
            {
                Type element = type.IsArray ? type.GetElementType() : type.GetGenericArguments()[0];
                text.Append('[');
                bool first = true;
                foreach (object item in (IEnumerable)value ?? new object[0]) { if (!first) text.Append(','); first = false; Write(text, item, element); }
                text.Append(']');
            }
            else WriteFields(text, value ?? FormatterServices.GetUninitializedObject(type), type);
        }
        static object Fill(object target, object json)
        {
            Dictionary<string, object> members = json as Dictionary<string, object>;
            if (members == null) throw new ArgumentException("the JSON is no object");
            foreach (FieldInfo field in Fields.Of(target.GetType()))
            {
                object member;
                if (members.TryGetValue(field.Name, out member)) field.SetValue(target, Read(member, field.FieldType, field.GetValue(target)));
            }
            return target;
        }
        static object Read(object json, Type type, object old)
        {
            if (type == typeof(string)) return json as string ?? "";
            if (typeof(Object).IsAssignableFrom(type))
            {
                Dictionary<string, object> reference = json as Dictionary<string, object>;
                object id;
                return reference != null && reference.TryGetValue("instanceID", out id) ? Registry.Find(Convert.ToInt32(id)) : null;
            }
            if (type == typeof(bool)) return json is bool ? json : old;
            if (type.IsEnum) return json is double ? Enum.ToObject(type, Convert.ToInt64(json)) : old;
            if (type.IsPrimitive) return json is double ? Convert.ChangeType(json, type, CultureInfo.InvariantCulture) : json is string && (type == typeof(float) || type == typeof(double)) ? Convert.ChangeType(double.Parse((string)json, CultureInfo.InvariantCulture), type) : old;
            if (type.IsArray || typeof(IList).IsAssignableFrom(type))
            {
                List<object> items = json as List<object> ?? new List<object>();
                Type element = type.IsArray ? type.GetElementType() : type.GetGenericArguments()[0];
                Array array = Array.CreateInstance(element, items.Count);
                for (int at = 0; at < items.Count; at++) array.SetValue(Read(items[at], element, null), at);
                if (type.IsArray) return array;
                IList list = (IList)Activator.CreateInstance(type);
                foreach (object item in array) list.Add(item);
                return list;
            }
            if (!(json is Dictionary<string, object>)) return old;
            return Fill(old ?? (type.GetConstructor(Type.EmptyTypes) != null || type.IsValueType ? Activator.CreateInstance(type) : FormatterServices.GetUninitializedObject(type)), json);
        }
    }
}

namespace UnityStubs
{
    /// JSON as dictionaries, lists, strings, doubles, booleans and null.
    public static class JsonText
    {
        public static object Parse(string text)
        {
            Reader reader = new Reader { Text = text };
            object value = reader.Value();
            reader.Blank();
            if (reader.At != text.Length) throw reader.Fault("text after the end");
            return value;
        }

        public static void Quote(StringBuilder text, string value)
        {
            text.Append('"');
            foreach (char c in value)
            {
                if (c == '"' || c == '\\') text.Append('\\').Append(c);
                else if (c == '\n') text.Append("\\n");
                else if (c == '\r') text.Append("\\r");
                else if (c == '\t') text.Append("\\t");
                else if (c < ' ') text.Append("\\u").Append(((int)c).ToString("x4"));
                else text.Append(c);
            }
            text.Append('"');
        }

        sealed class Reader
        {
            public string Text;
            public int At;

            public FormatException Fault(string what) { return new FormatException("character " + At + ": " + what); }
            public void Blank() { while (At < Text.Length && (Text[At] == ' ' || Text[At] == '\n' || Text[At] == '\r' || Text[At] == '\t' || Text[At] == '\uFEFF' || Text[At] == '\0')) At++; }
            bool Take(char c) { Blank(); if (At < Text.Length && Text[At] == c) { At++; return true; } return false; }
            void Need(char c) { if (!Take(c)) throw Fault("'" + c + "' is missing"); }
            bool Word(string word) { if (string.CompareOrdinal(Text, At, word, 0, word.Length) != 0) return false; At += word.Length; return true; }

            public object Value()
            {
                Blank();
                if (At >= Text.Length) throw Fault("a value is missing");
                if (Take('{'))
                {
                    Dictionary<string, object> members = new Dictionary<string, object>();
                    if (Take('}')) return members;
                    do { Blank(); string name = String(); Need(':'); members[name] = Value(); } while (Take(','));
                    Need('}');
                    return members;
                }
                if (Take('['))
                {
                    List<object> items = new List<object>();
                    if (Take(']')) return items;
                    do items.Add(Value()); while (Take(','));
                    Need(']');
                    return items;
                }
                if (Text[At] == '"') return String();
                if (Word("true")) return true;
                if (Word("false")) return false;
                if (Word("null")) return null;
                int start = At;
                while (At < Text.Length && "+-0123456789.eE".IndexOf(Text[At]) >= 0) At++;
                double number;
                if (!double.TryParse(Text.Substring(start, At - start), NumberStyles.Float, CultureInfo.InvariantCulture, out number)) throw Fault("a number is malformed");
                return number;
            }

            string String()
            {
                if (At >= Text.Length || Text[At] != '"') throw Fault("'\"' is missing");
                StringBuilder value = new StringBuilder();
                for (At++; At < Text.Length && Text[At] != '"'; At++)
                {
                    if (Text[At] != '\\') { value.Append(Text[At]); continue; }
                    if (++At >= Text.Length) break;
                    switch (Text[At])
                    {
                        case 'n': value.Append('\n'); break;
                        case 't': value.Append('\t'); break;
                        case 'r': value.Append('\r'); break;
                        case 'b': value.Append('\b'); break;
                        case 'f': value.Append('\f'); break;
                        case 'u': value.Append((char)int.Parse(Text.Substring(At + 1, 4), NumberStyles.HexNumber)); At += 4; break;
                        default: value.Append(Text[At]); break;
                    }
                }
                if (At >= Text.Length) throw Fault("a string has no end");
                At++;
                return value.ToString();
            }
        }
    }
}
