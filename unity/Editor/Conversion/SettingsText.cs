using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.Reflection;
using System.Text;

namespace SuperDeform.Editor
{
    /// <summary>
    /// Settings as lines of text, "Options.HeadScale = 1.2", without those that are as usual: what a component keeps, readable
    /// in a version control's difference. Objects of the project are kept beside it.
    /// </summary>
    public static class SettingsText
    {
        /// <summary>The lines for what differs from new settings; empty where nothing does.</summary>
        public static string Write(ConversionSettings settings)
        {
            var text = new StringBuilder();
            Write("", settings, Usual(), text);
            return text.ToString();
        }

        /// <summary>The settings that lines describe. Lines of other versions that cannot be understood are passed over.</summary>
        public static ConversionSettings Read(string text)
        {
            ConversionSettings settings = Usual();
            foreach (string line in (text ?? "").Split('\n'))
            {
                int equals = line.IndexOf('=');
                if (equals > 0) Assign(settings, line.Substring(0, equals).Trim().Split('.'), 0, line.Substring(equals + 1).Trim());
            }
            return settings;
        }

        /// <summary>The settings of a component, with the objects that it names.</summary>
        public static ConversionSettings Of(SuperDeformAvatar component)
        {
            ConversionSettings settings = Read(component.Settings);
            settings.ReferenceAvatar = component.ReferenceAvatar;
            settings.SavedStyle = component.SavedStyle;
            return settings;
        }

        /// <summary>Gives a component settings.</summary>
        public static void Give(SuperDeformAvatar component, ConversionSettings settings)
        {
            component.Settings = Write(settings);
            component.ReferenceAvatar = settings.ReferenceAvatar;
            component.SavedStyle = settings.SavedStyle;
        }

        static ConversionSettings Usual() => new ConversionSettings { Source = StyleSource.BuiltIn };

        static void Write(string prefix, object value, object usual, StringBuilder text)
        {
            foreach (FieldInfo field in value.GetType().GetFields(BindingFlags.Instance | BindingFlags.Public))
            {
                object now = field.GetValue(value), before = usual == null ? null : field.GetValue(usual);
                string name = prefix + field.Name;
                if (IsPlain(field.FieldType))
                {
                    if (!Equals(now, before)) text.Append(name).Append(" = ").Append(Plain(now)).Append('\n');
                }
                else if (now is IList)
                {
                    IList list = (IList)now;
                    for (int index = 0; index < list.Count; index++)
                    {
                        WriteElement(name + "." + index, list[index], text);
                    }
                }
                else if (now != null && !(now is UnityEngine.Object))
                {
                    Write(name + ".", now, before, text);
                }
            }
        }

        static void WriteElement(string name, object element, StringBuilder text)
        {
            if (element == null) return;
            if (IsPlain(element.GetType())) text.Append(name).Append(" = ").Append(Plain(element)).Append('\n');
            // Of an element everything is said: so it is there even where all is as usual.
            else Write(name + ".", element, null, text);
        }

        static void Assign(object target, string[] path, int at, string text)
        {
            FieldInfo field = target.GetType().GetField(path[at], BindingFlags.Instance | BindingFlags.Public);
            if (field == null || field.IsInitOnly) return;
            if (at == path.Length - 1)
            {
                object value = Parse(text, field.FieldType);
                if (value != null) field.SetValue(target, value);
                return;
            }
            object held = field.GetValue(target);
            if (held is IList && !(held is Array)) AssignElement((IList)held, field.FieldType.GetGenericArguments()[0], path, at + 1, text);
            else if (held != null && !IsPlain(field.FieldType) && !field.FieldType.IsValueType) Assign(held, path, at + 1, text);
        }

        static void AssignElement(IList list, Type type, string[] path, int at, string text)
        {
            if (!int.TryParse(path[at], NumberStyles.None, CultureInfo.InvariantCulture, out int index) || index > list.Count) return;
            bool whole = at == path.Length - 1;
            if (index == list.Count)
            {
                object made = whole ? Parse(text, type) : Activator.CreateInstance(type);
                if (made == null) return;
                list.Add(made);
            }
            if (whole) return;
            // A struct is a copy: it goes back into the list.
            object element = list[index];
            Assign(element, path, at + 1, text);
            list[index] = element;
        }

        static bool IsPlain(Type type) => type.IsPrimitive || type.IsEnum || type == typeof(string);

        static string Plain(object value)
        {
            if (value is double) return ((double)value).ToString("R", CultureInfo.InvariantCulture);
            if (value is float) return ((float)value).ToString("R", CultureInfo.InvariantCulture);
            return System.Convert.ToString(value, CultureInfo.InvariantCulture).Replace('\n', ' ');
        }

        /// <summary>Null where the text is no value of the type.</summary>
        static object Parse(string text, Type type)
        {
            try
            {
                if (type.IsEnum) return Enum.Parse(type, text);
                return IsPlain(type) ? System.Convert.ChangeType(text, type, CultureInfo.InvariantCulture) : null;
            }
            catch (Exception cause)
            {
                if (cause is FormatException || cause is ArgumentException || cause is OverflowException || cause is InvalidCastException) return null;
                throw;
            }
        }
    }
}
