// Types of fathom-view.js: a compiled scene in any page, by WebGL 2. How it is used: docs/web.md.

/** A number, a vector or colour (linear) of that many numbers, or whether it is on. Angles are in radians. */
export type ParamValue = number | number[] | boolean;

/** A uniform of the shader, as `fathom compile --reflect` writes it (docs/shaders.md). */
export interface Uniform {
  name: string;
  type: string;
  default?: number[];
  meaning?: string;
  param?: string;
  label?: string;
  color?: boolean;
  /** The least and the largest value. */
  range?: [number[], number[]];
  /** "deg", "turn" or "rad": how the scene writes the angle. */
  unit?: string;
  format?: string;
  /** Of a texture: width, height, depth. */
  size?: [number, number, number];
  texels?: number;
}

/** A param that stands in the text as a number. */
export interface Constant {
  value: number[];
  type: string;
  param: string;
  label: string;
  color: boolean;
  range?: [number[], number[]];
  unit?: string;
}

export interface Reflection {
  version: number;
  target: string;
  entry: string;
  reads_time: boolean;
  /** Seconds, from 0, that the scene is proved for. */
  time_end: number;
  uniforms: Uniform[];
  constants: Constant[];
}

/** A texture that the text reads. A page has its numbers packed in Scene.data; a host gives `values`. */
export interface Texture {
  name: string;
  /** RGBA of an image, linear, or one number a sample of a grid, in the order of fathom::Texture (fathom/shader.h). */
  values?: Float32Array;
  data?: number;
  bytes?: boolean;
}

/** A text of the scene: one for each choice of the params that decide what there is. */
export interface Variant {
  reflection: Reflection;
  /** GLSL ES 3.00, or in `packed` the same, deflated, as base64. */
  text?: string;
  packed?: string;
  /** Of a text that draws by passes: the steps of a ray in all, and in one draw. */
  passes?: {budget: number; steps: number};
  /** The params that this variant is for; none: it is the only one. */
  values?: Record<string, number[]>;
  textures?: Texture[];
}

export interface Scene {
  title: string;
  /** The first is the scene as it was written. */
  variants: Variant[];
  data?: string[];
}

/** The eye stands at the angles `around` (about y, from z) and `above` the horizon, radians, of x, y, z; `zoom` times as far off as in the first view. */
export interface Camera {
  around: number;
  above: number;
  zoom: number;
  x: number;
  y: number;
  z: number;
}

/** A param that can be set. `values`: all that it can be, of one that decides what there is; a single one: it is fixed. */
export interface Input {
  readonly name: string;
  readonly uniform: string;
  readonly label: string;
  readonly type: string;
  readonly color: boolean;
  readonly unit: string;
  readonly range?: [number[], number[]];
  readonly first: number[];
  readonly values?: number[][];
}

/** A scene from a page of `fathom compile --target html`; with `shader` from a reflection and its es300 text. Rejects where an address cannot be read. */
export function loadScene(address: string, shader?: string): Promise<Scene>;

/** The camera of the scene's first view. */
export function firstCamera(reflection: Reflection): Camera;

/** The values of the camera's uniforms, by name. `aspect`: the picture's width / height. */
export function cameraUniforms(reflection: Reflection, camera: Camera, aspect: number): Record<string, number[]>;

export interface FathomViewEvents {
  /** The scene is there: params, camera and time can be read and set. */
  load: CustomEvent<null>;
  /** A picture of the present state is shown, a coarse one at first. */
  draw: CustomEvent<null>;
  /** All samples of the present state are shown. */
  rest: CustomEvent<null>;
  /** The user moved something; what a program sets is not told. */
  change: CustomEvent<{what: "camera" | "time"} | {what: "param"; name: string}>;
  /** There is no picture, and why; the view shows the same words. */
  error: CustomEvent<{message: string}>;
}

/**
 * `<fathom-view src="scene.html">`. Attributes: `src`, a page of `--target html`, or a reflection whose es300 text is at
 * `shader`; `controls`, for the panel; `wheel`, for a wheel that zooms without a click before.
 * Before `load`, all but src, scene, inputs and animated throw an Error.
 */
export class FathomView extends HTMLElement {
  src: string;
  scene: Scene | null;
  readonly inputs: readonly Input[];
  readonly animated: boolean;
  /** All params by name. Setting takes some of them; throws a RangeError, and sets none, where one does not fit. */
  get params(): Record<string, ParamValue>;
  set params(values: Record<string, ParamValue>);
  /** A copy. Setting takes some of its numbers; throws a RangeError where one is not finite. */
  get camera(): Camera;
  set camera(values: Partial<Camera>);
  /** Seconds, from 0 to below Reflection.time_end; else a RangeError. */
  time: number;
  playing: boolean;
  /** 0 to 100 scene's seconds a second; else a RangeError. */
  speed: number;
  /** Of a pixel, at rest: 1 to 256; else a RangeError. */
  samples: number;
  /** How many of them are drawn of the present state. */
  readonly drawn: number;
  /** Camera and params as in the first view. */
  home(): void;
  /** The camera looks at its target from that side: from z, from x, or from above. */
  look(side: "front" | "right" | "top"): void;
  /** What is shown, as a PNG. Rejects before the first picture. */
  picture(): Promise<Blob>;
  addEventListener<K extends keyof FathomViewEvents>(type: K, listener: (event: FathomViewEvents[K]) => void, options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

declare global {
  interface HTMLElementTagNameMap {
    "fathom-view": FathomView;
  }
}
