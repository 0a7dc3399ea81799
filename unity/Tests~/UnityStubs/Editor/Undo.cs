// Undo: steps in groups; a recorded object gets its fields back, a created one is destroyed.
using System;
using System.Collections.Generic;
using System.Reflection;
using System.Runtime.Serialization;
using UnityEngine;
using UnityStubs;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public class Undo
    {
        public delegate void UndoRedoCallback();
        public static UndoRedoCallback undoRedoPerformed;

        abstract class Step { public int Group; public string Name; public abstract void Back(); }
        sealed class Created : Step { public Object What; public override void Back() { if (What != null) Object.DestroyImmediate(What); } }
        sealed class Recorded : Step
        {
            public Object What;
            public object[] Values;
            public override void Back() { if (What != null) Restore(What, Values); }
        }
        static readonly List<Step> s_Steps = new List<Step>();
        static int s_Group;
        static string s_GroupName = "";

        // What was undone and not done anew; a new step forgets it.
        static readonly List<List<Recorded>> s_Redo = new List<List<Recorded>>();

        static void Add(Step step, string name) { s_Redo.Clear(); step.Group = s_Group; step.Name = name; if (name != null) s_GroupName = name; s_Steps.Add(step); }
        static object[] Save(Object value)
        {
            FieldInfo[] fields = Fields.Of(value.GetType());
            object[] values = new object[fields.Length];
            for (int at = 0; at < fields.Length; at++) values[at] = Cloning.Copy(fields[at].GetValue(value), null, null, new Dictionary<object, object>());
            return values;
        }
        static void Restore(Object value, object[] values)
        {
            FieldInfo[] fields = Fields.Of(value.GetType());
            for (int at = 0; at < fields.Length; at++) fields[at].SetValue(value, values[at]);
        }

        public static void RegisterCreatedObjectUndo(Object objectToUndo, string name)
        {
            if (objectToUndo == null) throw new ArgumentNullException("objectToUndo");
            Add(new Created { What = objectToUndo }, name);
        }
        public static void RecordObject(Object objectToUndo, string name) { if (objectToUndo == null) throw new ArgumentNullException("objectToUndo"); Add(new Recorded { What = objectToUndo, Values = Save(objectToUndo) }, name); }
        public static void RecordObjects(Object[] objectsToUndo, string name) { foreach (Object value in objectsToUndo) RecordObject(value, name); }
        public static void RegisterCompleteObjectUndo(Object objectToUndo, string name) { RecordObject(objectToUndo, name); }
        public static void RegisterCompleteObjectUndo(Object[] objectsToUndo, string name) { RecordObjects(objectsToUndo, name); }
        public static void RegisterFullObjectHierarchyUndo(Object objectToUndo, string name)
        {
            GameObject top = (GameObject)objectToUndo;
            foreach (Transform at in top.GetComponentsInChildren<Transform>(true)) { RecordObject(at.gameObject, name); foreach (Component component in at.gameObject.components) RecordObject(component, name); }
        }
        public static T AddComponent<T>(GameObject gameObject) where T : Component { T made = gameObject.AddComponent<T>(); Add(new Created { What = made }, "Add Component"); return made; }
        public static Component AddComponent(GameObject gameObject, Type type) { Component made = gameObject.AddComponent(type); Add(new Created { What = made }, "Add Component"); return made; }
        public static void SetTransformParent(Transform transform, Transform newParent, string name) { RecordObject(transform, name); transform.SetParent(newParent); }
        // What was destroyed is not brought back here: no code under test relies on it.
        public static void DestroyObjectImmediate(Object objectToUndo) { Object.DestroyImmediate(objectToUndo); }
        public static void SetCurrentGroupName(string name) { s_GroupName = name; }
        public static string GetCurrentGroupName() { return s_GroupName; }
        public static int GetCurrentGroup() { return s_Group; }
        public static void IncrementCurrentGroup() { s_Group++; s_GroupName = ""; }
        public static void CollapseUndoOperations(int groupIndex) { foreach (Step step in s_Steps) if (step.Group > groupIndex) step.Group = groupIndex; }
        public static void RevertAllInCurrentGroup() { Back(s_Group); }
        public static void RevertAllDownToGroup(int group) { for (int at = s_Group; at >= group; at--) Back(at); }
        public static void FlushUndoRecordObjects() { }
        public static void ClearAll() { s_Steps.Clear(); s_Redo.Clear(); s_Group++; s_GroupName = ""; }
        public static void ClearUndo(Object identifier) { s_Steps.RemoveAll(delegate (Step step) { return step is Recorded && ((Recorded)step).What == identifier || step is Created && ((Created)step).What == identifier; }); }
        public static void PerformUndo()
        {
            if (s_Steps.Count == 0) return;
            List<Recorded> undone = new List<Recorded>();
            foreach (Step step in s_Steps) if (step is Recorded && step.Group == s_Steps[s_Steps.Count - 1].Group) undone.Add((Recorded)step);
            List<Recorded> redo = undone.ConvertAll(step => new Recorded { What = step.What, Values = step.What == null ? null : Save(step.What), Name = step.Name, Group = step.Group });
            Back(s_Steps[s_Steps.Count - 1].Group);
            s_Redo.Add(redo);
            UndoRedoCallback listeners = undoRedoPerformed;
            if (listeners != null) listeners();
        }
        // Changes come back; what was created and destroyed again does not.
        public static void PerformRedo()
        {
            if (s_Redo.Count == 0) return;
            List<Recorded> redo = s_Redo[s_Redo.Count - 1];
            s_Redo.RemoveAt(s_Redo.Count - 1);
            foreach (Recorded step in redo)
            {
                if (step.What == null) continue;
                s_Steps.Add(new Recorded { What = step.What, Values = Save(step.What), Name = step.Name, Group = step.Group });
                Restore(step.What, step.Values);
            }
            UndoRedoCallback listeners = undoRedoPerformed;
            if (listeners != null) listeners();
        }
        static void Back(int group)
        {
            for (int at = s_Steps.Count - 1; at >= 0; at--)
            {
                if (s_Steps[at].Group != group) continue;
                Step step = s_Steps[at];
                s_Steps.RemoveAt(at);
                step.Back();
            }
        }
        internal static int StepCount { get { return s_Steps.Count; } }
    }

    public sealed class Selection
    {
        static Object[] s_Objects = new Object[0];
        public static Action selectionChanged;
        public static Object[] objects { get { return Array.FindAll(s_Objects, delegate (Object value) { return value != null; }); } set { s_Objects = value ?? new Object[0]; Action listeners = selectionChanged; if (listeners != null) listeners(); } }
        public static Object activeObject { get { Object[] all = objects; return all.Length == 0 ? null : all[0]; } set { objects = value == null ? new Object[0] : new[] { value }; } }
        public static GameObject activeGameObject { get { return activeObject as GameObject; } set { activeObject = value; } }
        public static Transform activeTransform { get { GameObject top = activeGameObject; return top == null || EditorUtility.IsPersistent(top) ? null : top.transform; } set { activeObject = value == null ? null : value.gameObject; } }
        public static int activeInstanceID { get { return activeObject == null ? 0 : activeObject.GetInstanceID(); } }
        public static GameObject[] gameObjects { get { return Array.ConvertAll(Array.FindAll(objects, delegate (Object value) { return value is GameObject; }), delegate (Object value) { return (GameObject)value; }); } }
        public static Transform[] transforms { get { return Array.ConvertAll(Array.FindAll(gameObjects, delegate (GameObject value) { return !EditorUtility.IsPersistent(value); }), delegate (GameObject value) { return value.transform; }); } }
        public static bool Contains(Object obj) { return Array.IndexOf(objects, obj) >= 0; }
        public static T[] GetFiltered<T>(SelectionMode mode) { List<T> found = new List<T>(); foreach (Object value in objects) if (value is T) found.Add((T)(object)value); return found.ToArray(); }
    }
    [Flags] public enum SelectionMode { Unfiltered = 0, TopLevel = 1, Deep = 2, ExcludePrefab = 4, Editable = 8, Assets = 16, DeepAssets = 32 }
}
