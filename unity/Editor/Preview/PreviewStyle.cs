using System;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>The style of a preview. A reference avatar is measured once, not whenever a slider moves.</summary>
    internal sealed class PreviewStyle : IDisposable
    {
        Style measured;
        GameObject measuredOn;

        /// <summary>The style that settings describe, as ConversionSettings.MakeStyle gives it.</summary>
        /// <remarks>The caller disposes it.</remarks>
        internal Style Make(ConversionSettings settings)
        {
            if (settings.Source != StyleSource.ReferenceAvatar || settings.ReferenceAvatar == null) return settings.MakeStyle();
            if (measuredOn != settings.ReferenceAvatar)
            {
                Dispose();
                ConversionSettings plain = settings.Clone();
                plain.Blend = 0;
                measured = plain.MakeStyle();
                measuredOn = settings.ReferenceAvatar;
            }
            using (Style stretched = Style.FromHeads(Exact.Of(settings.Heads), measured))
            {
                return Style.Blend(measured, stretched, Exact.Of(settings.Blend));
            }
        }

        public void Dispose()
        {
            if (measured != null) measured.Dispose();
            measured = null;
            measuredOn = null;
        }
    }
}
