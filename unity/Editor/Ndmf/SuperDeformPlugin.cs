using System;
using System.Collections.Generic;
using nadena.dev.ndmf;
using nadena.dev.ndmf.animator;
using nadena.dev.ndmf.localization;
using nadena.dev.ndmf.preview;
using UnityEditor;
using UnityEngine;

[assembly: ExportsPlugin(typeof(SuperDeform.Editor.Ndmf.SuperDeformPlugin))]

namespace SuperDeform.Editor.Ndmf
{
    /// <summary>
    /// The step of an NDMF build that deforms an avatar with a Super Deform Avatar component: the build's copy, never the avatar.
    /// </summary>
    [RunsOnAllPlatforms]
    public sealed class SuperDeformPlugin : Plugin<SuperDeformPlugin>
    {
        static Localizer texts;

        public override string QualifiedName => "com.superdeform.converter";

        public override string DisplayName => "Super Deform";

        // After outfits are merged and textures made, before what measures the body (floor, humanoid pose); optimizers have a
        // phase of their own behind this one.
        protected override void Configure()
        {
            InPhase(BuildPhase.Transforming)
                .AfterPlugin("nadena.dev.modular-avatar")
                .AfterPlugin("net.rs64.tex-trans-tool")
                .BeforePlugin("nadena.dev.modular-avatar.late-transform-stages")
                .BeforePlugin("net.narazaka.vrchat.floor_adjuster")
                .WithRequiredExtension(typeof(AnimatorServicesContext), sequence => sequence
                    .Run("Super-deform the avatar", Deform)
                    .PreviewingWith(new SuperDeformPreview()));
        }

        internal static void Deform(BuildContext context)
        {
            GameObject avatar = context.AvatarRootObject;
            SuperDeformAvatar[] found = avatar.GetComponentsInChildren<SuperDeformAvatar>(true);
            if (found.Length == 0) return;
            SuperDeformAvatar component = avatar.GetComponent<SuperDeformAvatar>();
            try
            {
                if (component == null)
                {
                    Say(new Finding("component_not_on_root", Severity.Error, found[0], found[0].name, avatar.name));
                    return;
                }
                ConversionResult done;
                var clips = new BuildClips(context);
                using (var progress = new EditorProgress(avatar.name, cancelable: false))
                {
                    done = Converter.ConvertInPlace(avatar, SettingsText.Of(component), progress, clips, result => Keep(context, result, clips));
                }
                foreach (Finding finding in done.Findings)
                {
                    if (finding.Severity != Severity.Info) Say(finding);
                }
            }
            catch (Exception cause)
            {
                // Whatever it is, it is one sentence in the report: an exception would say less, and as much of the avatar is left.
                Finding finding = ConversionException.From(cause, avatar).Finding;
                Say(finding.Key == "failed" ? new Finding("in_place_failed", Severity.Error, finding.Where, finding.Values) : finding);
            }
            finally
            {
                foreach (SuperDeformAvatar one in found)
                {
                    UnityEngine.Object.DestroyImmediate(one);
                }
            }
        }

        static void Keep(BuildContext context, ConversionResult done, BuildClips clips)
        {
            foreach (UnityEngine.Object asset in done.Assets)
            {
                context.AssetSaver.SaveAsset(asset);
            }
            foreach (KeyValuePair<UnityEngine.Object, UnityEngine.Object> pair in done.Replaced)
            {
                // One that is known already, through somebody else's report, stays known as that.
                if (pair.Key != null && pair.Value != null)
                {
                    ObjectRegistry.TryRegisterReplacedObject(ObjectRegistry.GetReference(pair.Key), pair.Value);
                }
            }
            clips.Commit();
        }

        static void Say(Finding finding)
        {
            ErrorSeverity severity = finding.Severity == Severity.Error ? ErrorSeverity.Error
                : finding.Severity == Severity.Warning ? ErrorSeverity.NonFatal : ErrorSeverity.Information;
            // An object among the values becomes a link to it; none may be null.
            if (finding.Where == null) ErrorReport.ReportError(Texts, severity, "ndmf.note", finding.Text);
            else ErrorReport.ReportError(Texts, severity, "ndmf.note", finding.Text, finding.Where);
        }

        static Localizer Texts => texts ?? (texts = new Localizer("en-US", new Func<List<ValueTuple<string, Func<string, string>>>>(Languages)));

        // Sentences come whole and in the package's own language; the title alone is looked up.
        static List<ValueTuple<string, Func<string, string>>> Languages() =>
            new List<ValueTuple<string, Func<string, string>>> { new ValueTuple<string, Func<string, string>>("en-US", Text) };

        static string Text(string key) => key == "ndmf.note" ? Strings.Get("ndmf.note") : key == "ndmf.note:description" ? "{0}" : null;

        // NDMF shows the avatar through proxies of its own while any of its previews is on: they rest while ours is shown.
        [InitializeOnLoadMethod]
        internal static void YieldToPreview()
        {
            PreviewSession.Shown -= Yield;
            PreviewSession.Shown += Yield;
        }

        static void Yield(bool shown)
        {
            NDMFPreview.DisablePreviewDepth = Math.Max(0, NDMFPreview.DisablePreviewDepth + (shown ? 1 : -1));
        }
    }
}
