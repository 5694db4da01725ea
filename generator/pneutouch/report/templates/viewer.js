// The 3D views. The picture in the page stays where it is when WebGL is missing, fails or is lost.
document.querySelectorAll(".view").forEach(function (box) {
  "use strict";
  var source = document.getElementById(box.id + "-data");
  if (!source) return;

  var VERTEX =
    "attribute vec3 position, normal, colour; uniform mat3 turn; uniform vec2 scale, shift; uniform vec3 light; uniform float relief;" +
    "varying vec3 shade;" +
    "void main() { vec3 seen = turn * position, n = normalize(normal);" +
    "float diffuse = max(dot(turn * n, light), 0.0);" +
    "shade = colour * (relief * (0.42 + 0.62 * diffuse + 0.05 * n.z) + 1.0 - relief);" +
    "gl_Position = vec4((seen.xy - shift) * scale, -0.4 * seen.z, 1.0); }";
  var FRAGMENT = "precision mediump float; varying vec3 shade; void main() { gl_FragColor = vec4(shade, 1.0); }";
  var data = JSON.parse(source.textContent);
  var turned = -62 * Math.PI / 180, tilted = data.tilt_deg * Math.PI / 180, zoom = 1;
  var start = rotation(turned, tilted), light = unit(times(start, [-0.35, -0.55, 0.76]));

  function unit(v) { var n = Math.hypot(v[0], v[1], v[2]); return [v[0] / n, v[1] / n, v[2] / n]; }
  function times(rows, v) { return rows.map(function (r) { return r[0] * v[0] + r[1] * v[1] + r[2] * v[2]; }); }
  // Rows: right, up and towards the viewer.
  function rotation(turn, tilt) {
    var c = Math.cos(turn), s = Math.sin(turn), ct = Math.cos(tilt), st = Math.sin(tilt);
    return [[-s, c, 0], [-st * c, -st * s, ct], [ct * c, ct * s, st]];
  }
  function bytes(text) {
    var raw = atob(text), out = new Uint8Array(raw.length);
    for (var k = 0; k < raw.length; k++) out[k] = raw.charCodeAt(k);
    return out;
  }
  function program(gl) {
    var made = gl.createProgram();
    [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]].forEach(function (one) {
      var shader = gl.createShader(one[0]);
      gl.shaderSource(shader, one[1]);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    });
    ["position", "normal", "colour"].forEach(function (name, k) { gl.bindAttribLocation(made, k, name); });
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error("the 3D view cannot be drawn here");
    return made;
  }
  function loaded(gl, body) {
    function filled(target, data) {
      var buffer = gl.createBuffer();
      gl.bindBuffer(target, buffer);
      gl.bufferData(target, data, gl.STATIC_DRAW);
      return buffer;
    }
    // Three values of two bytes and three of one would not be aligned: each vertex gets a fourth.
    function padded(values, Kind) {
      var out = new Kind(values.length / 3 * 4);
      for (var k = 0; k < values.length; k++) out[4 * Math.floor(k / 3) + k % 3] = values[k];
      return out;
    }
    var triangles = body.columns ? grid(body) : new Uint16Array(bytes(body.triangles).buffer);
    return {
      count: triangles.length,
      relief: body.relief,
      triangles: filled(gl.ELEMENT_ARRAY_BUFFER, triangles),
      arrays: [
        [gl.SHORT, 8, filled(gl.ARRAY_BUFFER, padded(new Int16Array(bytes(body.positions).buffer), Int16Array))],
        [gl.BYTE, 4, filled(gl.ARRAY_BUFFER, padded(new Int8Array(bytes(body.normals).buffer), Int8Array))],
        [gl.UNSIGNED_BYTE, 4, filled(gl.ARRAY_BUFFER, padded(bytes(body.colours), Uint8Array))]
      ]
    };
  }
  // Two triangles to a field of a grid that closes around its axis.
  function grid(body) {
    var n = body.columns, fields = bytes(body.positions).length / 6 - n, out = new Uint16Array(6 * fields);
    for (var k = 0; k < fields; k++) {
      var next = k - k % n + (k + 1) % n;
      out.set([k, next, next + n, k, next + n, k + n], 6 * k);
    }
    return out;
  }
  // The least and the greatest of what is seen at the start, across and upwards.
  function extent(bodies) {
    var low = [9, 9], high = [-9, -9];
    bodies.forEach(function (body) {
      var p = new Int16Array(bytes(body.positions).buffer);
      for (var k = 0; k < p.length; k += 3) {
        var seen = times(start, [p[k] / 32767, p[k + 1] / 32767, p[k + 2] / 32767]);
        for (var i = 0; i < 2; i++) { low[i] = Math.min(low[i], seen[i]); high[i] = Math.max(high[i], seen[i]); }
      }
    });
    return { across: high[0] - low[0], up: high[1] - low[1], middle: [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2] };
  }

  function begin() {
    var canvas = document.createElement("canvas");
    var gl = canvas.getContext("webgl", { antialias: true, alpha: false });
    if (!gl) return;
    var made = program(gl), most = extent(data.bodies);
    var parts = data.bodies.map(function (body) { return loaded(gl, body); });
    var waiting = false;

    function draw() {
      waiting = false;
      var ratio = window.devicePixelRatio || 1, width = box.clientWidth, height = box.clientHeight;
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
      var size = zoom * 0.94 * Math.min(width / most.across, height / most.up);
      var rows = rotation(turned, tilted);
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(1, 1, 1, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      gl.useProgram(made);
      gl.uniformMatrix3fv(gl.getUniformLocation(made, "turn"), false, [0, 1, 2].reduce(function (all, k) {
        return all.concat([rows[0][k], rows[1][k], rows[2][k]]);
      }, []));
      gl.uniform2f(gl.getUniformLocation(made, "scale"), 2 * size / width, 2 * size / height);
      gl.uniform2f(gl.getUniformLocation(made, "shift"), most.middle[0], most.middle[1]);
      gl.uniform3fv(gl.getUniformLocation(made, "light"), light);
      parts.forEach(function (part) {
        gl.uniform1f(gl.getUniformLocation(made, "relief"), part.relief);
        part.arrays.forEach(function (array, k) {
          gl.bindBuffer(gl.ARRAY_BUFFER, array[2]);
          gl.enableVertexAttribArray(k);
          gl.vertexAttribPointer(k, 3, array[0], true, array[1], 0);
        });
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, part.triangles);
        gl.drawElements(gl.TRIANGLES, part.count, gl.UNSIGNED_SHORT, 0);
      });
    }
    function again() { if (!waiting) { waiting = true; requestAnimationFrame(draw); } }
    function turn(across, up) {
      turned -= across;
      tilted = Math.max(-1.5, Math.min(1.5, tilted + up));
      again();
    }
    function magnify(by) { zoom = Math.max(0.5, Math.min(6, zoom * by)); again(); }

    var held = null;
    canvas.addEventListener("pointerdown", function (event) {
      held = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", function (event) {
      if (!held) return;
      turn((event.clientX - held[0]) * 0.009, (event.clientY - held[1]) * 0.009);
      held = [event.clientX, event.clientY];
    });
    ["pointerup", "pointercancel"].forEach(function (name) {
      canvas.addEventListener(name, function () { held = null; });
    });
    // The wheel scrolls the page; it zooms once the view has the focus, after a click.
    canvas.addEventListener("wheel", function (event) {
      if (document.activeElement !== canvas) return;
      event.preventDefault();
      magnify(Math.exp(-0.0012 * event.deltaY));
    }, { passive: false });
    canvas.addEventListener("keydown", function (event) {
      var step = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] }[event.key];
      if (step) turn(step[0], step[1]);
      else if (event.key === "+" || event.key === "-") magnify(event.key === "+" ? 1.15 : 1 / 1.15);
      else return;
      event.preventDefault();
    });
    canvas.addEventListener("webglcontextlost", function () {
      canvas.remove();
      box.classList.remove("live");
    });
    window.addEventListener("resize", again);
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", box.querySelector("img").alt + "; arrow keys turn it, + and - zoom");
    box.appendChild(canvas);
    box.classList.add("live");
    draw();
  }

  try { begin(); } catch (error) { box.classList.remove("live"); }
});
