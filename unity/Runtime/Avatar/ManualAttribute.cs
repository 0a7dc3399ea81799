using System;
using System.Diagnostics;
using UnityEngine;

namespace SuperDeform
{
    /// <summary>Lets the button with the question mark, in the Inspector, open the manual of this package.</summary>
    /// <remarks>
    /// Unity opens an address of HelpURL as it stands, and makes the attribute anew for each press. It finds no file by a path within
    /// a package ("Packages/..."), so the editor says where the manual lies.
    /// </remarks>
    [AttributeUsage(AttributeTargets.Class), Conditional("UNITY_EDITOR")]
    internal sealed class ManualAttribute : HelpURLAttribute
    {
        /// <summary>Gives the manual's address; null in players, where nobody asks.</summary>
        internal static Func<string> Address { get; set; }

        public ManualAttribute() : base(Address == null ? "" : Address()) { }
    }
}
