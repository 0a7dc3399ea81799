using System;
using System.Collections.Generic;
using System.IO;
using UnityEditor;
using UnityEngine;

namespace SuperDeform.Editor
{
    /// <summary>Converts several avatars, in the editor or from the command line; never opens a dialog.</summary>
    /// <remarks>
    /// <code>
    /// Unity -batchmode -projectPath PROJECT -executeMethod SuperDeform.Editor.BatchConvert.Run
    ///   -superdeformAvatars "Assets/A.prefab;Assets/B.prefab"
    ///   -superdeformHeads 2.5                            1.8 to 6; or
    ///   -superdeformReference Assets/Chibi.prefab        a rigged SD character; or
    ///   -superdeformStyle sd2.5                          sd2, sd2.5, sd3, sd4, or a saved style: Assets/chibi.json
    ///   -superdeformBlend 0.5                            0 the reference or saved style, 1 the heads
    ///   -superdeformAmount 1  -superdeformHeadScale 1.5  -superdeformFaceCurve f4  -superdeformRigFingers no  ...
    ///                                                    every number, word, yes or no of the class Options, by its name
    ///   -superdeformGroup upper_leg:length=0.4,thickness=0.8     may stand several times
    ///   -superdeformRig keep|auto
    ///   -superdeformOutput Assets/Chibis  -superdeformNewCopy yes|no  -superdeformReport report.json
    ///   -superdeformAllowProhibited yes|no               licences that forbid changes: yes says that you have permission
    ///   -superdeformLanguage en|ja|ko|zh
    /// </code>
    /// Leave out Unity's -quit: the command ends Unity itself. Exit code: 0 all were converted, 1 some were not, 2 the
    /// command line is wrong.
    /// </remarks>
    public static class BatchConvert
    {
        const string Mark = "[Super Deform] ";

        /// <summary>For -executeMethod: reads the command line, converts, prints a line an avatar, ends Unity.</summary>
        public static void Run()
        {
            int code;
            try
            {
                code = Run(Environment.GetCommandLineArgs());
            }
            catch (Exception fault)
            {
                Debug.LogException(fault);
                code = 1;
            }
            // A person who tries the command in an open editor keeps it open.
            if (Application.isBatchMode) EditorApplication.Exit(code);
        }

        /// <summary>As Run, for given arguments.</summary>
        /// <returns>The exit code.</returns>
        public static int Run(IList<string> commandLine)
        {
            BatchArguments arguments;
            try
            {
                arguments = BatchArguments.Read(commandLine);
            }
            catch (ArgumentException wrong)
            {
                Debug.LogError(Mark + wrong.Message);
                return 2;
            }
            var report = new BatchReport();
            foreach (string path in arguments.Avatars)
            {
                GameObject avatar = AssetDatabase.LoadAssetAtPath<GameObject>(path);
                if (avatar != null && arguments.AllowProhibited) Licences.Allow(avatar);
                BatchEntry entry = avatar == null
                    ? new BatchEntry { Avatar = path, Failure = Strings.Get("batch.not_found", path) }
                    : ConvertOne(avatar, arguments.Settings, null);
                report.Entries.Add(entry);
            }
            foreach (string line in report.Lines())
            {
                Debug.Log(Mark + line);
            }
            if (arguments.ReportPath != null && !WriteReport(arguments.ReportPath, report)) return 1;
            return report.Failed == 0 ? 0 : 1;
        }

        /// <summary>Converts avatars one after the other; one that fails does not stop the others.</summary>
        public static BatchReport Convert(IEnumerable<GameObject> avatars, ConversionSettings settings) => Convert(avatars, settings, null);

        /// <summary>As above, with progress over all; cancelling leaves out the avatar at work and those after it.</summary>
        public static BatchReport Convert(IEnumerable<GameObject> avatars, ConversionSettings settings,
            IConversionProgress progress)
        {
            var report = new BatchReport();
            var all = new List<GameObject>(avatars).FindAll(avatar => avatar != null);
            for (int i = 0; i < all.Count; i++)
            {
                GameObject avatar = all[i];
                try
                {
                    report.Entries.Add(ConvertOne(avatar, settings, Share.Of(progress, i, all.Count)));
                }
                catch (ConversionException)
                {
                    report.Cancelled = true;
                    report.Entries.Add(new BatchEntry
                    {
                        Avatar = NameOf(avatar), Failure = Strings.Get("batch.cancelled", NameOf(avatar))
                    });
                    break;
                }
            }
            return report;
        }

        static BatchEntry ConvertOne(GameObject avatar, ConversionSettings settings, IConversionProgress progress)
        {
            var entry = new BatchEntry { Avatar = NameOf(avatar) };
            try
            {
                entry.Result = Converter.Convert(avatar, settings, progress);
            }
            catch (Exception fault)
            {
                ConversionException reason = ConversionException.From(fault, avatar);
                if (reason.Cancelled) throw reason;
                entry.Failure = reason.Message;
            }
            return entry;
        }

        /// <summary>One avatar's share of the progress of a batch.</summary>
        sealed class Share : IConversionProgress
        {
            IConversionProgress whole;
            int index, count;

            internal static Share Of(IConversionProgress whole, int index, int count) =>
                whole == null ? null : new Share { whole = whole, index = index, count = count };

            public bool Report(string stageKey, float fraction) => whole.Report(stageKey, (index + fraction) / count);
        }

        static bool WriteReport(string path, BatchReport report)
        {
            try
            {
                File.WriteAllText(path, report.ToJson());
                return true;
            }
            catch (Exception fault)
            {
                Debug.LogError(Mark + Strings.Get("error.report_file", path, fault.Message));
                return false;
            }
        }

        static string NameOf(GameObject avatar)
        {
            string path = AssetDatabase.GetAssetPath(avatar);
            return string.IsNullOrEmpty(path) ? avatar.name : path;
        }
    }
}
