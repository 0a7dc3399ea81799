using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace SuperDeform.Editor.WindowPicture
{
    /// <summary>An SVG in the making: rectangles, texts and paths in the colours of Unity's dark editor.</summary>
    internal sealed class Canvas
    {
        internal const string Background = "#383838", Header = "#414141", Line = "#232323", Field = "#2a2a2a";
        internal const string Button = "#585858", Pressed = "#46607c", Words = "#d2d2d2", Faint = "#9a9a9a", Bright = "#ffffff";
        internal const string Track = "#5e5e5e", Knob = "#999999", Box = "#404040";
        const double Size = 12;

        readonly StringBuilder svg = new StringBuilder();

        internal void Rectangle(double x, double y, double width, double height, string fill, double corner = 0,
            string stroke = null)
        {
            svg.Append("<rect x=\"").Append(Number(x)).Append("\" y=\"").Append(Number(y)).Append("\" width=\"")
                .Append(Number(width)).Append("\" height=\"").Append(Number(height)).Append('"');
            if (corner > 0) svg.Append(" rx=\"").Append(Number(corner)).Append('"');
            svg.Append(" fill=\"").Append(fill).Append('"');
            if (stroke != null) svg.Append(" stroke=\"").Append(stroke).Append('"');
            svg.Append("/>\n");
        }

        internal void Circle(double x, double y, double radius, string fill)
        {
            svg.Append("<circle cx=\"").Append(Number(x)).Append("\" cy=\"").Append(Number(y)).Append("\" r=\"")
                .Append(Number(radius)).Append("\" fill=\"").Append(fill).Append("\"/>\n");
        }

        internal void Path(string path, string fill)
        {
            svg.Append("<path d=\"").Append(path).Append("\" fill=\"").Append(fill).Append("\"/>\n");
        }

        /// <param name="y">Of the base line.</param>
        /// <param name="anchor">start, middle or end: which part of the text stands at x.</param>
        internal void Text(double x, double y, string text, string fill, string anchor = "start", bool bold = false,
            double size = Size)
        {
            svg.Append("<text x=\"").Append(Number(x)).Append("\" y=\"").Append(Number(y)).Append("\" fill=\"").Append(fill)
                .Append('"');
            if (anchor != "start") svg.Append(" text-anchor=\"").Append(anchor).Append('"');
            if (bold) svg.Append(" font-weight=\"bold\"");
            if (size != Size) svg.Append(" font-size=\"").Append(Number(size)).Append('"');
            svg.Append('>').Append(Escaped(text)).Append("</text>\n");
        }

        /// <summary>A text cut to a width, with an ellipsis.</summary>
        internal static string Cut(string text, double width)
        {
            if (Width(text) <= width) return text;
            int length = text.Length;
            while (length > 0 && Width(text.Substring(0, length) + "\u2026") > width) length--;
            return text.Substring(0, length) + "\u2026";
        }

        /// <summary>A text in lines of a width: broken between words, or between any two Japanese letters.</summary>
        internal static List<string> Wrap(string text, double width)
        {
            var lines = new List<string>();
            string line = "";
            int at = 0;
            while (at < text.Length)
            {
                int end = at + 1;
                if (!IsWide(text[at]))
                {
                    while (end < text.Length && text[end] != ' ' && !IsWide(text[end])) end++;
                }
                // A line does not begin with a full stop or a closing bracket.
                while (end < text.Length && ")\u3002\u3001\uff09\u300d".IndexOf(text[end]) >= 0) end++;
                string word = text.Substring(at, end - at);
                if (line.Length > 0 && Width(line + word) > width)
                {
                    lines.Add(line);
                    line = word.TrimStart();
                }
                else line += word;
                at = end;
            }
            lines.Add(line);
            return lines;
        }

        /// <summary>About how wide a text is: there is no font here to ask.</summary>
        internal static double Width(string text)
        {
            double width = 0;
            foreach (char letter in text)
            {
                width += IsWide(letter) ? 1 : "iljI.,:;|!'() ".IndexOf(letter) >= 0 ? 0.32
                    : "mwMW%\u2026".IndexOf(letter) >= 0 ? 0.86 : char.IsUpper(letter) ? 0.68 : 0.56;
            }
            return width * Size;
        }

        static bool IsWide(char letter)
        {
            return letter >= '\u2e80' && letter < '\ufb00' || letter >= '\uff00' && letter < '\uff61';
        }

        internal static string Number(double value)
        {
            return value.ToString("0.##", CultureInfo.InvariantCulture);
        }

        static string Escaped(string text)
        {
            return text.Replace("&", "&amp;").Replace("<", "&lt;").Replace(">", "&gt;");
        }

        internal string Finish(double width, double height)
        {
            return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Number(width) + "\" height=\"" + Number(height)
                + "\" viewBox=\"0 0 " + Number(width) + " " + Number(height)
                + "\" font-family=\"Inter, 'Segoe UI', 'Helvetica Neue', Arial, 'Noto Sans JP', 'Noto Sans CJK JP', 'Hiragino Sans',"
                + " Meiryo, sans-serif\" font-size=\"12\">\n" + svg + "</svg>\n";
        }
    }
}
