using System;
using System.Text;

namespace SuperDeform
{
/// <summary>
/// What a character should become: numbers, not a model. It can be saved, mixed, and used with any character, and keeps
/// nothing of the character that it was measured on.
/// </summary>
public sealed class Style : NativeObject
{
    Style() { }

    internal SdefStyle Raw => new SdefStyle { id = Handle };

    /// <summary>A style of so many heads.</summary>
    /// <param name="heads">1.8 to 6, crown to sole over crown to chin.</param>
    /// <param name="like">
    /// A style with everything below its head stretched or shortened; null: everything after the target.
    /// </param>
    public static unsafe Style FromHeads(double heads, Style like = null)
    {
        var style = new Style();
        var made = new SdefStyle();
        SdefError error = Failure.None();
        SdefStyle other = like == null ? new SdefStyle() : like.Raw;
        uint status = Native.sdef_style_from_heads(heads, other, &made, &error);
        GC.KeepAlive(like);
        return style.Take(status, &error, made);
    }

    /// <summary>A built-in style ("sd2", "sd2.5", "sd3" or "sd4"), or one that <see cref="ToJson"/> gave.</summary>
    public static unsafe Style FromText(string text)
    {
        if (text == null) throw new ArgumentNullException("text");
        var style = new Style();
        var made = new SdefStyle();
        SdefError error = Failure.None();
        byte[] bytes = Encoding.UTF8.GetBytes(text);
        uint status;
        fixed (byte* start = bytes)
        {
            status = Native.sdef_style_from_text((sbyte*)start, (UIntPtr)(uint)bytes.Length, &made, &error);
        }
        return style.Take(status, &error, made);
    }

    /// <summary>Measures a super-deformed character, so that others can be made like it.</summary>
    /// <param name="character">With a skeleton or a made rig.</param>
    /// <param name="name">Of the style; may be null.</param>
    /// <param name="options">Mode, Rays, BoneGroups and ThreadCount are read; null: the defaults.</param>
    public static unsafe Style Measure(Character character, string name = null, Options options = null)
    {
        if (character == null) throw new ArgumentNullException("character");
        var style = new Style();
        var made = new SdefStyle();
        SdefError error = Failure.None();
        using (var scope = new MarshalScope())
        {
            uint status = Native.sdef_style_measure(character.Raw, scope.Text(name), scope.Options(options), &made,
                &error);
            GC.KeepAlive(character);
            return style.Take(status, &error, made);
        }
    }

    /// <summary>A style from numbers, as <see cref="Numbers"/> and <see cref="Bones"/> give them; its slices are those of a
    /// body of so many heads.</summary>
    /// <param name="name">Of the style; may be null.</param>
    /// <param name="numbers">What is known.</param>
    /// <param name="bones">For paper mode; may be null.</param>
    public static unsafe Style FromNumbers(string name, StyleNumbers numbers, Bone[] bones = null)
    {
        if (numbers == null) throw new ArgumentNullException("numbers");
        var style = new Style();
        var made = new SdefStyle();
        SdefError error = Failure.None();
        int count = bones == null ? 0 : bones.Length;
        using (var scope = new MarshalScope())
        {
            SdefBone* native = (SdefBone*)scope.Alloc(checked(count * sizeof(SdefBone)));
            for (int i = 0; i < count; i++)
            {
                native[i].struct_size = (uint)sizeof(SdefBone);
                native[i].end = unchecked((uint)bones[i].End);
                native[i].length = bones[i].Length;
                native[i].radius = bones[i].Radius;
            }
            SdefStyleNumbers values = numbers.ToNative();
            uint status = Native.sdef_style_from_numbers(scope.Text(name), &values, native, (UIntPtr)(uint)count, &made,
                &error);
            return style.Take(status, &error, made);
        }
    }

    /// <summary>A style between two, measured in heads.</summary>
    /// <param name="first">Amount 0.</param>
    /// <param name="second">Amount 1.</param>
    /// <param name="amount">0 is first, 1 second; 0 to 1.</param>
    public static unsafe Style Blend(Style first, Style second, double amount)
    {
        if (first == null) throw new ArgumentNullException("first");
        if (second == null) throw new ArgumentNullException("second");
        var style = new Style();
        var made = new SdefStyle();
        SdefError error = Failure.None();
        uint status = Native.sdef_style_blend(first.Raw, second.Raw, amount, &made, &error);
        GC.KeepAlive(first);
        GC.KeepAlive(second);
        return style.Take(status, &error, made);
    }

    /// <summary>The style as JSON text, to be saved.</summary>
    /// <exception cref="InvalidInputException">A style of N heads that is like none: save the number.</exception>
    public unsafe string ToJson()
    {
        SdefStyle raw = Raw;
        string json = Text.Read((text, capacity, size, error) =>
            Native.sdef_style_to_json(raw, text, capacity, size, error));
        GC.KeepAlive(this);
        return json;
    }

    /// <summary>The style as numbers.</summary>
    public unsafe StyleNumbers Numbers
    {
        get
        {
            var numbers = new SdefStyleNumbers();
            numbers.struct_size = (uint)sizeof(SdefStyleNumbers);
            SdefError error = Failure.None();
            uint status = Native.sdef_style_get_numbers(Raw, &numbers, null, UIntPtr.Zero, null, &error);
            GC.KeepAlive(this);
            Failure.Check(status, &error);
            return new StyleNumbers(numbers);
        }
    }

    /// <summary>The bones, in the order of their ends, the head's last; empty where none are known.</summary>
    public unsafe Bone[] Bones
    {
        get
        {
            UIntPtr count = UIntPtr.Zero;
            SdefError error = Failure.None();
            uint status = Native.sdef_style_get_numbers(Raw, null, null, UIntPtr.Zero, &count, &error);
            Failure.Check(status, &error);
            SdefBone[] native = new SdefBone[(int)count];
            fixed (SdefBone* start = native)
            {
                if (native.Length > 0) start->struct_size = (uint)sizeof(SdefBone);
                status = Native.sdef_style_get_numbers(Raw, null, start, count, &count, &error);
            }
            GC.KeepAlive(this);
            Failure.Check(status, &error);
            Bone[] bones = new Bone[native.Length];
            for (int i = 0; i < bones.Length; i++)
            {
                bones[i].End = (HumanoidRole)native[i].end;
                bones[i].Length = native[i].length;
                bones[i].Radius = native[i].radius;
            }
            return bones;
        }
    }

    unsafe Style Take(uint status, SdefError* error, SdefStyle made)
    {
        Failure.Check(status, error);
        Handle = made.id;
        return this;
    }
}
}
