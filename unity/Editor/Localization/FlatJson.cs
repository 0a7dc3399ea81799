using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace SuperDeform.Editor
{
    /// <summary>Reads one JSON object whose values are all texts: what a file of translations is.</summary>
    /// <remarks>Unity's JsonUtility reads no dictionaries.</remarks>
    internal static class FlatJson
    {
        /// <summary>The members of the object, in the order of the file.</summary>
        /// <exception cref="FormatException">The text is no such object, or says a key twice; with line and column.</exception>
        internal static List<KeyValuePair<string, string>> Read(string text)
        {
            var members = new List<KeyValuePair<string, string>>();
            var keys = new HashSet<string>();
            int at = 0;
            if (text.Length > 0 && text[0] == '\uFEFF') at++;
            Expect(text, ref at, '{');
            if (Peek(text, ref at) != '}')
            {
                while (true)
                {
                    string key = Text(text, ref at);
                    if (!keys.Add(key)) throw Wrong(text, at, "the key " + key + " stands here a second time");
                    Expect(text, ref at, ':');
                    members.Add(new KeyValuePair<string, string>(key, Text(text, ref at)));
                    if (Peek(text, ref at) != ',') break;
                    at++;
                }
            }
            Expect(text, ref at, '}');
            if (Peek(text, ref at) != '\0') throw Wrong(text, at, "nothing may follow the object");
            return members;
        }

        /// <summary>A text as JSON writes it, with its quotes.</summary>
        internal static string Quote(string text)
        {
            var result = new StringBuilder("\"");
            foreach (char letter in text ?? "")
            {
                if (letter == '"' || letter == '\\') result.Append('\\').Append(letter);
                else if (letter < ' ') result.AppendFormat(CultureInfo.InvariantCulture, "\\u{0:x4}", (int)letter);
                else result.Append(letter);
            }
            return result.Append('"').ToString();
        }

        static char Peek(string text, ref int at)
        {
            while (at < text.Length && (text[at] == ' ' || text[at] == '\t' || text[at] == '\r' || text[at] == '\n'))
            {
                at++;
            }
            return at < text.Length ? text[at] : '\0';
        }

        static void Expect(string text, ref int at, char wanted)
        {
            if (Peek(text, ref at) != wanted) throw Wrong(text, at, "expected " + wanted);
            at++;
        }

        static string Text(string text, ref int at)
        {
            Expect(text, ref at, '"');
            var result = new StringBuilder();
            while (at < text.Length && text[at] != '"')
            {
                char letter = text[at++];
                if (letter < ' ') throw Wrong(text, at, "a text ends on its own line: write \\n");
                result.Append(letter == '\\' ? Escaped(text, ref at) : letter);
            }
            Expect(text, ref at, '"');
            return result.ToString();
        }

        static char Escaped(string text, ref int at)
        {
            char letter = at < text.Length ? text[at++] : '\0';
            switch (letter)
            {
                case '"': case '\\': case '/': return letter;
                case 'b': return '\b';
                case 'f': return '\f';
                case 'n': return '\n';
                case 'r': return '\r';
                case 't': return '\t';
            }
            int code = 0;
            if (letter != 'u' || at + 4 > text.Length || !int.TryParse(text.Substring(at, 4),
                NumberStyles.AllowHexSpecifier, CultureInfo.InvariantCulture, out code))
            {
                throw Wrong(text, at, "there is no such escape as \\" + letter);
            }
            at += 4;
            return (char)code;
        }

        static FormatException Wrong(string text, int at, string what)
        {
            int line = 1, column = 1;
            for (int i = 0; i < at && i < text.Length; i++)
            {
                column++;
                if (text[i] == '\n')
                {
                    line++;
                    column = 1;
                }
            }
            return new FormatException(string.Format(CultureInfo.InvariantCulture, "line {0}, column {1}: {2}",
                line, column, what));
        }
    }
}
