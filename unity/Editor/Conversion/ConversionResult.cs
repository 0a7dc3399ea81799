using System.Collections.Generic;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>What a conversion leaves behind.</summary>
    public sealed class ConversionResult
    {
        /// <summary>The prefab of the super-deformed avatar.</summary>
        public GameObject Prefab;

        /// <summary>
        /// Its path, such as "Assets/Mika_SD/Mika_SD.prefab"; meshes, Avatar and settings are in the .asset beside it.
        /// </summary>
        public string PrefabPath;

        /// <summary>True where an earlier result was brought up to date.</summary>
        public bool Updated;

        /// <summary>
        /// The prefab's instance beside the source; null where the source is no object of a scene or none was wanted.
        /// </summary>
        public GameObject Instance;

        /// <summary>Meshes, the Avatar and materials of an avatar that was converted in place; they belong to nobody yet.</summary>
        public readonly List<Object> Assets = new List<Object>();

        /// <summary>Of an avatar that was converted in place: what it had, and what it has instead.</summary>
        public readonly List<KeyValuePair<Object, Object>> Replaced = new List<KeyValuePair<Object, Object>>();

        /// <summary>The numbers of the run.</summary>
        public Report Report;

        /// <summary>The same and more, as JSON text.</summary>
        public string ReportJson;

        /// <summary>Warnings and notes about it.</summary>
        public List<Finding> Findings = new List<Finding>();
    }
}
