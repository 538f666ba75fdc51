// What both pages share: a view that the mouse turns, and a slider for each param, from a scene's reflection.

// The view of the uniforms' defaults; `changed` is called when the mouse has moved it.
export function firstView(byName, element, changed) {
  const origin = byName.fathom_origin.default, forward = byName.fathom_forward.default;
  const focus = byName.fathom_focus.default[0];
  const view = {
    target: origin.map((c, i) => c + focus * forward[i]),
    around: Math.atan2(-forward[0], -forward[2]),
    above: Math.asin(Math.max(-1, Math.min(1, -forward[1]))),
    focus,
  };
  element.addEventListener("pointerdown", e => element.setPointerCapture(e.pointerId));
  element.addEventListener("pointermove", e => {
    if (!e.buttons) return;
    view.around -= 0.008 * e.movementX;
    view.above = Math.max(-1.57, Math.min(1.57, view.above + 0.008 * e.movementY));
    changed();
  });
  element.addEventListener("wheel", e => { e.preventDefault(); view.focus *= Math.exp(0.001 * e.deltaY); changed(); }, { passive: false });
  return view;
}

export function viewUniforms(view) {
  const ca = Math.cos(view.around), sa = Math.sin(view.around), cb = Math.cos(view.above), sb = Math.sin(view.above);
  const back = [cb * sa, sb, cb * ca];
  return {
    fathom_origin: view.target.map((c, i) => c + view.focus * back[i]),
    fathom_right: [ca, 0, -sa],
    fathom_up: [-sb * sa, cb, -sb * ca],
    fathom_forward: back.map(c => -c),
    fathom_focus: [view.focus],
  };
}

// A slider for each number of each param; `set` is called with the input and its values.
export function addControls(parent, inputs, set) {
  for (const u of inputs.filter(u => u.param)) {
    const value = [...u.default];
    value.forEach((start, i) => {
      const label = document.createElement("label"), slider = document.createElement("input");
      slider.type = u.range ? "range" : "number";
      if (u.range) [slider.min, slider.max] = [u.range[0][i], u.range[1][i]];
      slider.step = u.type === "int" || u.type === "bool" ? 1 : "any";
      slider.value = start;
      slider.addEventListener("input", () => { value[i] = Number(slider.value); set(u, value); });
      label.append((u.label || u.param) + " ", slider);
      parent.append(label);
    });
  }
}
