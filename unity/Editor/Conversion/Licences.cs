using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>
    /// What the licence of a VRM avatar says about changing it. One that forbids changes is asked about once: who may change it
    /// says so.
    /// </summary>
    /// <remarks>Read through serialized properties, so that UniVRM is not needed; of several statements the strictest counts.</remarks>
    internal static class Licences
    {
        internal enum Changes
        {
            NotStated,
            Allowed,
            NotToShare,
            Prohibited
        }

        const string Vrm0 = "VRM.VRMMeta", Vrm1 = "UniVRM10.Vrm10Instance", Preference = "SuperDeform.MayChange.";

        static readonly Dictionary<string, Changes> Words = new Dictionary<string, Changes>
        {
            { "prohibited", Changes.Prohibited }, { "allowModification", Changes.NotToShare },
            { "allowModificationRedistribution", Changes.Allowed },
            { "CC0", Changes.Allowed }, { "CC_BY", Changes.Allowed }, { "CC_BY_NC", Changes.Allowed }, { "CC_BY_SA", Changes.Allowed },
            { "CC_BY_NC_SA", Changes.Allowed }, { "CC_BY_ND", Changes.Prohibited }, { "CC_BY_NC_ND", Changes.Prohibited },
            { "Redistribution_Prohibited", Changes.NotToShare }
        };

        /// <summary>Licences that somebody has said to have permission for, until the editor is closed.</summary>
        static readonly HashSet<string> allowed = new HashSet<string>();

        /// <summary>Adds what an artist should know of an avatar's licence.</summary>
        internal static void Check(GameObject avatar, List<Finding> findings)
        {
            Statement said = Of(avatar);
            if (said == null || said.Changes == Changes.NotToShare)
            {
                if (said != null) findings.Add(new Finding("licence_not_to_share", Severity.Warning, said.Where, avatar.name, said.Because));
                return;
            }
            if (said.Changes != Changes.Prohibited || allowed.Contains(said.Key) || EditorPrefs.GetBool(Preference + said.Key, false)) return;
            findings.Add(new Finding("licence_prohibited", Severity.Error, said.Where, avatar.name, said.Because)
                .WithFix("fix_licence", () => EditorPrefs.SetBool(Preference + said.Key, true)));
        }

        /// <summary>Takes a person's word for this session, as a command line gives it.</summary>
        internal static void Allow(GameObject avatar)
        {
            Statement said = Of(avatar);
            if (said != null) allowed.Add(said.Key);
        }

        /// <summary>Takes all words for this session back.</summary>
        internal static void Forget()
        {
            allowed.Clear();
        }

        sealed class Statement
        {
            internal Changes Changes;
            internal string Because, Key;
            internal Component Where;

            internal void Hear(Changes changes, string because)
            {
                if (changes <= Changes) return;
                Changes = changes;
                Because = because;
            }
        }

        /// <summary>Null where there is no licence.</summary>
        static Statement Of(GameObject avatar)
        {
            foreach (Component component in avatar.GetComponentsInChildren<Component>(true))
            {
                // Null where a script is missing.
                string type = component == null ? null : Serialized.TypeOf(component);
                if (type != Vrm0 && type != Vrm1) continue;
                UnityEngine.Object asset;
                using (var properties = new SerializedObject(component))
                {
                    SerializedProperty holder = properties.FindProperty(type == Vrm0 ? "Meta" : "Vrm");
                    asset = holder == null ? null : holder.objectReferenceValue;
                }
                if (asset == null) continue;
                var said = new Statement { Where = component, Key = KeyOf(asset, avatar) };
                using (var meta = new SerializedObject(asset))
                {
                    if (type == Vrm0) Hear(said, meta, "LicenseType", "OtherPermissionUrl", "OtherLicenseUrl");
                    else Hear(said, meta, "Meta.Modification", "Meta.OtherLicenseUrl");
                }
                return said;
            }
            return null;
        }

        static string KeyOf(UnityEngine.Object asset, GameObject avatar)
        {
            string path = AssetDatabase.GetAssetPath(asset);
            return string.IsNullOrEmpty(path) ? new SourceIdentity(avatar).ToString() : AssetDatabase.AssetPathToGUID(path);
        }

        static void Hear(Statement said, SerializedObject meta, string words, params string[] addresses)
        {
            string word = WordAt(meta, words);
            if (Words.TryGetValue(word, out Changes changes)) said.Hear(changes, word);
            foreach (string path in addresses)
            {
                string address = Serialized.TextAt(meta, path);
                if (!string.IsNullOrEmpty(address)) said.Hear(OfAddress(address), address);
            }
        }

        /// <summary>The word of an enumeration; empty where there is none, or one of another version.</summary>
        static string WordAt(SerializedObject meta, string path)
        {
            SerializedProperty property = meta.FindProperty(path);
            if (property == null || property.propertyType != SerializedPropertyType.Enum) return "";
            int index = property.enumValueIndex;
            return index >= 0 && index < property.enumNames.Length ? property.enumNames[index] : "";
        }

        /// <summary>
        /// What the address of a licence says by itself: VRoid Hub's has modification=disallow in it, Creative Commons' the
        /// licence's name.
        /// </summary>
        internal static Changes OfAddress(string address)
        {
            if (!Uri.TryCreate(address.Trim().ToLowerInvariant(), UriKind.Absolute, out Uri uri)) return Changes.NotStated;
            string host = uri.Host.StartsWith("www.", StringComparison.Ordinal) ? uri.Host.Substring(4) : uri.Host;
            if (host == "hub.vroid.com" && uri.AbsolutePath.TrimEnd('/').EndsWith("license", StringComparison.Ordinal)) return OfHub(uri.Query.TrimStart('?').Split('&'));
            if (host != "creativecommons.org") return Changes.NotStated;
            string[] parts = uri.AbsolutePath.Split(new[] { '/' }, StringSplitOptions.RemoveEmptyEntries);
            if (parts.Length < 2 || parts[0] != "licenses" && parts[0] != "publicdomain") return Changes.NotStated;
            return parts[0] == "licenses" && Array.IndexOf(parts[1].Split('-'), "nd") >= 0 ? Changes.Prohibited : Changes.Allowed;
        }

        static Changes OfHub(string[] says)
        {
            if (Array.IndexOf(says, "modification=disallow") >= 0) return Changes.Prohibited;
            if (Array.IndexOf(says, "redistribution=disallow") >= 0) return Changes.NotToShare;
            return Array.Exists(says, pair => pair.StartsWith("modification=", StringComparison.Ordinal)) ? Changes.Allowed : Changes.NotStated;
        }
    }
}
