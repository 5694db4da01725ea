// What has to change with a field: a resin takes a printer that runs it, an object and a shape need sizes to begin with.

export class Following {
  /** `printers` has by the name of a material those that run it. */
  constructor(form, printers) {
    Object.assign(this, { form, printers });
  }

  /** Changed fields by name that go with the change of one. */
  of(name, text, state, answer) {
    if (name === "membrane.material") return this.printer(text);
    if (name === "membrane.shape" && answer) return this.shape(text, state, answer);
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

  /** Sizes of a shape in proportion to the inner radius; those of other shapes are left out. */
  shape(chosen, state, answer) {
    const radius = Number(state.values["membrane.inner_radius_mm"] ?? answer.values.membrane.inner_radius_mm);
    const scaled = (share) => (Array.isArray(share) ? share.map(scaled) : Number((radius * share).toPrecision(3)));
    const own = this.form.shapes[chosen] ?? {};
    const given = {};
    for (const key of [...this.form.ofShapes, "membrane.root_fillet_mm"]) {
      if (own[key] !== undefined && own[key] !== null) given[key] = JSON.stringify(scaled(own[key]));
      else if (state.values[key] || answer.values.membrane[key.split(".")[1]] !== undefined) given[key] = null;
    }
    return given;
  }

  printer(material) {
    const names = this.printers[material] ?? [];
    const now = this.form.fields.get("print.profile").input.value;
    return !names.length || names.includes(now) ? {} : { "print.profile": names[0] };
  }
}
