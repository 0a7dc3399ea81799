/** What becomes of a character. All numbers but `heads` go from 0 to 1 unless they say otherwise. */
export interface Options {
  /** How many heads tall, 1.8 to 6. */
  heads?: number;
  /** A built-in style (sd2.5 unless anything else is given), or a saved one. */
  style?: 'sd2' | 'sd2.5' | 'sd3' | 'sd4' | object;
  /** A model (GLB or VRM) whose proportions are taken. */
  reference?: Uint8Array;
  /** The file's name, for sentences; one that ends in .gltf is JSON with files. */
  name?: string;
  /** The files that a .gltf names. */
  files?: Record<string, Uint8Array>;
  /** Converts what its licence forbids to change: you are its author, or may change it. */
  allowProhibited?: boolean;
  /** Each spring chain of a VRM 0.x gets one joint more. */
  leafJoints?: boolean;
  /** A VRM's legs get colliders where its skirt hangs from springs that none keeps out of them. */
  legColliders?: boolean;
  /** How much of the shade that is painted around the eyes goes; 0.8 for photos and 0 for drawn faces unless set. */
  evenEyes?: number;
  amount?: number;
  /** .1 to 10; 1.5 is the style's own. */
  head_scale?: number;
  profile?: number;
  hair_length?: number;
  /** -10 to 10. */
  face_squash?: number;
  face_curve?: 'f4' | 'f2' | 'sphere';
  youth?: number;
  youth_eye?: number;
  youth_lower?: number;
  youth_nose?: number;
  youth_cheek?: number;
  youth_jaw?: number;
  youth_skull?: number;
  youth_ear?: number;
  smile?: number;
  seat?: number;
  hair_lay?: number;
  repair?: 'off' | 'on';
  /** As the style makes it, as tall as before, or so many units. */
  height?: 'style' | 'keep' | number;
  mode?: 'product' | 'paper';
  stage?: 'length' | 'thickness' | 'face';
  /** Parts of the body by name, such as upper_arm, hand, foot: a scale of 1 keeps the part as it is, a transfer of 1 takes all of the style. */
  groups?: Record<string, { length_scale?: number; thickness_scale?: number; length_transfer?: number; thickness_transfer?: number }>;
}

export interface Result {
  /** A GLB; of a VRM, a VRM. */
  bytes: Uint8Array;
  /** The numbers, as the command line's report has them; times are 0. */
  report: any;
}

/** A character (GLB, VRM 0.x or 1.0) as its super-deformed self. Throws Refused, with one sentence, where it cannot be. */
export function superdeform(bytes: Uint8Array, options?: Options): Promise<Result>;
export default superdeform;

/** Gives the package its superdeform.wasm, where it cannot be fetched from beside it: bundlers, pages without a server. */
export function load(wasm: BufferSource): void;

/** What was refused, in one sentence. */
export class Refused extends Error {
  /** The option that it is about. */
  option: string | null;
}

/** A fault of the library. */
export class Fault extends Error {}
