// The character that is open: its file, what the library knows of it, and its latest result.
import { Shown } from './shown.js';
import { isModel, MOST_BYTES, ordered, read } from './files.js';
import { t } from './words.js';

const megabytes = (bytes) => Math.round(bytes / 1e6);

/** Reads what was dropped or chosen; the model comes first. Throws a sentence. */
export async function gathered(given) {
  const files = ordered(given);
  if (!isModel(files[0])) throw new Error(t('error.kind', files[0].name));
  const size = files.reduce((sum, { file }) => sum + file.size, 0);
  if (size > MOST_BYTES) throw new Error(t('error.large', files[0].name, megabytes(size), megabytes(MOST_BYTES)));
  return Promise.all(files.map(read));
}

export class Character {
  latest = null;

  constructor(client, files) {
    Object.assign(this, { client, files, name: files[0].name.split('/').pop() });
  }

  /** `allowed`: the user may change what its licence forbids to change. */
  async open(allowed = false) {
    this.allowed = allowed;
    this.about = await this.client.ask({ do: 'open', allow_prohibited: allowed }, this.files);
  }

  /** The character as it came: with the rig that it moves by, and as one file. */
  async before() {
    const asItCame = !this.about.new_rig && /\.(vrm|glb)$/i.test(this.name);
    const bytes = asItCame ? this.files[0].bytes : (await this.client.ask({ do: 'rigged' })).files[0].bytes;
    return Shown.read(bytes, this.about);
  }

  /** For while a slider moves: a file to renew what is shown by. */
  async glimpse({ style, options }) {
    const quick = options.repair === 'off' ? options : { ...options, repair: 'kept' };
    await this.client.ask({ do: 'set', style, options: quick });
    return (await this.client.ask({ do: 'glimpse' })).files[0].bytes;
  }

  /** What the result's file is called. */
  get resultName() {
    return this.name.replace(/\.(\w+)$/, (_, ending) => `_sd.${ending.toLowerCase() === 'vrm' ? 'vrm' : 'glb'}`);
  }

  async result({ style, options }) {
    await this.client.ask({ do: 'set', style, options });
    const question = { do: 'write', name: this.resultName, by_reference: style.reference === true };
    const { report, files } = await this.client.ask(question);
    this.latest = { name: this.resultName, bytes: files[0].bytes, text: report, report: JSON.parse(report) };
    return this.latest;
  }
}
