using SuperDeform.Editor;
using UnityEditor;
using UnityEngine;

/// <summary>Converts the selected avatar to 2.5 heads, by a script of your own.</summary>
public static class QuickStart
{
    const string Item = "GameObject/Super Deform/Quick start: 2.5 heads";

    [MenuItem(Item, true)]
    static bool CanConvert()
    {
        GameObject avatar = Selection.activeGameObject;
        return avatar != null && avatar.GetComponent<Animator>() != null;
    }

    [MenuItem(Item)]
    static void Convert()
    {
        var settings = new ConversionSettings { Heads = 2.5f };
        try
        {
            ConversionResult result = Converter.Convert(Selection.activeGameObject, settings, null);
            foreach (Finding finding in result.Findings)
            {
                Debug.Log(finding.Text, finding.Where);
            }
            EditorGUIUtility.PingObject(result.Prefab);
        }
        catch (ConversionException refused)
        {
            // One sentence that says what to do; nothing was left behind.
            Debug.LogWarning(refused.Message, Selection.activeGameObject);
        }
    }
}
