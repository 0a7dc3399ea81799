using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace SuperDeform.Tests
{
/// <summary>
/// A strict reader of JSON (RFC 8259): objects are dictionaries, arrays lists, numbers doubles, null is null. Throws
/// FormatException where the text is none.
/// </summary>
public sealed class Json
{
    readonly string text;
    int at;

    Json(string text)
    {
        this.text = text;
    }

    public static object Read(string text)
    {
        var json = new Json(text);
        object value = json.Value();
        json.Space();
        if (json.at != text.Length) throw json.Wrong();
        return value;
    }

    object Value()
    {
        Space();
        switch (Peek())
        {
            case '{': return Object();
            case '[': return Array();
            case '"': return String();
            case 't': return Word("true", true);
            case 'f': return Word("false", false);
            case 'n': return Word("null", null);
            default: return Number();
        }
    }

    Dictionary<string, object> Object()
    {
        var members = new Dictionary<string, object>();
        at++;
        Space();
        if (Peek() == '}') { at++; return members; }
        for (;;)
        {
            Space();
            if (Peek() != '"') throw Wrong();
            string name = String();
            Space();
            Take(':');
            members.Add(name, Value());
            Space();
            if (Peek() == '}') { at++; return members; }
            Take(',');
        }
    }

    List<object> Array()
    {
        var items = new List<object>();
        at++;
        Space();
        if (Peek() == ']') { at++; return items; }
        for (;;)
        {
            items.Add(Value());
            Space();
            if (Peek() == ']') { at++; return items; }
            Take(',');
        }
    }

    string String()
    {
        var value = new StringBuilder();
        at++;
        while (Peek() != '"')
        {
            char letter = text[at++];
            if (letter < ' ') throw Wrong();
            if (letter != '\\') { value.Append(letter); continue; }
            char escaped = Peek();
            at++;
            int known = "\"\\/bfnrt".IndexOf(escaped);
            if (known >= 0) value.Append("\"\\/\b\f\n\r\t"[known]);
            else if (escaped == 'u')
            {
                if (at + 4 > text.Length) throw Wrong();
                string digits = text.Substring(at, 4);
                value.Append((char)int.Parse(digits, NumberStyles.HexNumber, CultureInfo.InvariantCulture));
                at += 4;
            }
            else throw Wrong();
        }
        at++;
        return value.ToString();
    }

    double Number()
    {
        int start = at;
        while (at < text.Length && "+-.0123456789eE".IndexOf(text[at]) >= 0) at++;
        string digits = text.Substring(start, at - start);
        if (!double.TryParse(digits, NumberStyles.Float, CultureInfo.InvariantCulture, out double number)) throw Wrong();
        return number;
    }

    object Word(string word, object value)
    {
        if (string.CompareOrdinal(text, at, word, 0, word.Length) != 0) throw Wrong();
        at += word.Length;
        return value;
    }

    char Peek()
    {
        if (at >= text.Length) throw Wrong();
        return text[at];
    }

    void Take(char letter)
    {
        if (Peek() != letter) throw Wrong();
        at++;
    }

    void Space()
    {
        while (at < text.Length && " \t\r\n".IndexOf(text[at]) >= 0) at++;
    }

    FormatException Wrong() => new FormatException("no JSON at character " + at + " of: " + text);
}
}
