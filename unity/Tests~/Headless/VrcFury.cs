// VRCFury's component by its serialized fields; read in the source of github.com/VRCFury/VRCFury 1.1423 (Runtime/Model/VRCFury.cs,
// Feature/ArmatureLink.cs). What a build makes of it happens behind NDMF's passes.
using System;
using System.Collections.Generic;
using UnityEngine;

namespace VF.Model
{
    public class VRCFury : MonoBehaviour
    {
        [SerializeReference] public Feature.FeatureModel content;
    }
}

namespace VF.Model.Feature
{
    [Serializable]
    public abstract class FeatureModel { }

    [Serializable]
    public class ArmatureLink : FeatureModel
    {
        [Serializable]
        public class LinkTo
        {
            public bool useBone = true;
            public HumanBodyBones bone = HumanBodyBones.Hips;
            public bool useObj;
            public GameObject obj;
            public string offset = "";
        }

        public GameObject propBone;
        public List<LinkTo> linkTo = new List<LinkTo> { new LinkTo() };
        public string removeBoneSuffix = "";
        public bool recursive;
    }

    [Serializable]
    public class Toggle : FeatureModel
    {
        public List<GameObject> objects = new List<GameObject>();
        // Managed references may go round in a circle.
        [SerializeReference] public FeatureModel other;
    }
}
