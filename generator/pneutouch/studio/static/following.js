// What has to change with a field: a resin takes a printer that runs it, an object needs sizes to begin with.

export class Following {
  /** `printers` has by the name of a material those that run it. */
  constructor(form, printers) {
    Object.assign(this, { form, printers });
  }

  /** Changed fields by name that go with the change of one. */
  of(name, text, state, answer) {
    if (name === "membrane.material") return this.printer(text);
    return name === "contact.object" && answer ? this.sizes(text, state, answer) : {};
  }

  sizes(object, state, answer) {
    const radius = Number(answer.values.membrane.inner_radius_mm);
    const begin = { "contact.ring_section_radius_mm": radius / 5, "contact.ring_radius_mm": radius / 2, "contact.cone_half_angle_deg": 60 };
    const given = {};
    for (const key of this.form.sizes[object] ?? []) {
      const [table, field] = key.split(".");
      if (state.values[key] || answer.values[table][field] !== null) continue;
      if (key === "contact.profile_mm") given[key] = `[[0, 0], [${radius}, ${radius / 4}]]`;
      else given[key] = String(Number((begin[key] ?? radius / 2).toPrecision(3)));
    }
    return given;
  }

  printer(material) {
    const names = this.printers[material] ?? [];
    const now = this.form.fields.get("print.profile").input.value;
    return !names.length || names.includes(now) ? {} : { "print.profile": names[0] };
  }
}
