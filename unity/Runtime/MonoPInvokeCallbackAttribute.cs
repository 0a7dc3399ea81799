using System;

namespace SuperDeform
{
/// <summary>
/// Marks a method that native code calls. IL2CPP goes by the attribute's name; the engine's own is out of reach of an
/// assembly without engine references.
/// </summary>
[AttributeUsage(AttributeTargets.Method)]
internal sealed class MonoPInvokeCallbackAttribute : Attribute
{
    public MonoPInvokeCallbackAttribute(Type delegateType)
    {
        DelegateType = delegateType;
    }

    public Type DelegateType { get; private set; }
}
}
