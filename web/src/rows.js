// What stands where on the page.

/** What stands where. Ranges and defaults come from the library; a slider may show less of a range than there is. */
export const ROWS = {
  main: ['heads', 'amount', 'youth', 'head_scale', 'hair_length'],
  face: ['youth_eye', 'youth_lower', 'youth_nose', 'youth_cheek', 'youth_jaw', 'youth_skull', 'youth_ear', 'face_squash', 'smile'],
  body: ['profile', 'seat'],
  hair: ['hair_lay'],
};

/** Parts of the body that have numbers of their own, as in the Unity window: their length and thickness, or what one slider is. */
export const GROUPS = {
  body: { neck: null, torso: null, shoulder: 'spread', upper_arm: null, lower_arm: null, hip: 'spread', upper_leg: null, lower_leg: null },
  ends: { hand: 'size', foot: 'size' },
};

/** The names of the sliders of parts: `upper_arm.length_scale`. */
export const groupSliders = (groups) =>
  Object.entries(groups).flatMap(([group, is]) => (is ? ['length'] : ['length', 'thickness']).map((part) => `${group}.${part}_scale`));
