using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    public enum Severity
    {
        /// <summary>Good to know.</summary>
        Info,

        /// <summary>The conversion works, but perhaps not as wished.</summary>
        Warning,

        /// <summary>The conversion cannot be done.</summary>
        Error
    }

    /// <summary>
    /// Something that an artist should know about an avatar or a conversion: one sentence, and where there is one, the fix.
    /// </summary>
    public sealed class Finding
    {
        /// <summary>The key of the sentence in the tables of strings, such as "not_readable".</summary>
        public string Key;

        /// <summary>What stands in the sentence's gaps; may be null.</summary>
        public object[] Values;

        public Severity Severity;

        /// <summary>The object that it is about, for a click that shows it; may be null.</summary>
        public UnityEngine.Object Where;

        /// <summary>The key of the fix button's label; null where there is no fix.</summary>
        public string FixKey;

        /// <summary>Mends it, with Undo where Unity can undo it; null where there is no fix.</summary>
        public Action Fix;

        /// <summary>The avatar to choose instead, where that is the way out; else null.</summary>
        public GameObject Choice;

        public Finding(string key, Severity severity, UnityEngine.Object where, params object[] values)
        {
            Key = key;
            Severity = severity;
            Where = where;
            Values = values;
        }

        /// <summary>The finding with a button that mends it.</summary>
        public Finding WithFix(string fixKey, Action fix)
        {
            FixKey = fixKey;
            Fix = fix;
            return this;
        }

        /// <summary>The finding with a button that chooses another avatar; null: without.</summary>
        public Finding WithChoice(GameObject choice)
        {
            Choice = choice;
            return this;
        }

        /// <summary>The sentence in the editor's language.</summary>
        public string Text => Strings.Get(Key, Values ?? new object[0]);

        public override string ToString() => Text;
    }
}
