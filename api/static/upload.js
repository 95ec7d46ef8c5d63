// The upload form: looks at the files as soon as they are chosen, shows what each is, and says how far sending is.
// Without this file the form still works: the server finds the placements and asks where it cannot.
"use strict";

(() => {
  const form = document.querySelector("[data-session-form]");
  const area = document.querySelector("[data-upload]");
  if (!form || !area) return;

  const input = area.querySelector("input[type=file]");
  const drop = area.querySelector("[data-drop]");
  const status = area.querySelector("[data-status]");
  const problemSlot = area.querySelector("[data-problem]");
  const table = area.querySelector("[data-placements]");
  const rows = area.querySelector("[data-rows]");
  const rowTemplate = document.querySelector("template[data-row]");
  const noticeTemplate = document.querySelector("template[data-notice]");
  const submit = form.querySelector("[data-submit]");
  const sending = form.querySelector("[data-sending]");
  const progress = form.querySelector("[data-progress]");
  const sent = form.querySelector("[data-sent]");
  const token = form.elements.form_token;
  let loggedOut = false;
  let chosen = [...input.files];
  let asked = 0;

  drop.classList.add("live");
  const again = area.querySelector(".again");

  // ---- choosing -------------------------------------------------------------------------------------------------
  input.addEventListener("change", () => take([...input.files]));
  for (const kind of ["dragenter", "dragover"]) {
    drop.addEventListener(kind, (event) => {
      event.preventDefault();
      drop.classList.add("over");
    });
  }
  for (const kind of ["dragleave", "drop"]) drop.addEventListener(kind, () => drop.classList.remove("over"));
  drop.addEventListener("drop", (event) => {
    event.preventDefault();
    take([...event.dataTransfer.files]);
  });

  // The placements go by file name, so a name must stand for one file. Choosing a file again is no second file.
  async function take(files) {
    const twice = new Set();
    for (const file of files) {
      const at = chosen.findIndex((one) => one.name === file.name);
      if (at < 0) chosen.push(file);
      else if (sameFile(chosen[at], file) || unread(file.name)) chosen[at] = file;
      else twice.add(file.name);
    }
    keep();
    await inspect();
    for (const name of twice) {
      tell({ detail: `Two different files are called ${name}; only the first is used.`, hint: "Rename one of them and choose it again, or remove the first." });
    }
  }

  function sameFile(a, b) {
    return a.size === b.size && a.lastModified === b.lastModified;
  }

  function unread(name) {
    return [...rows.children].some((one) => one.dataset.file === name && one.querySelector("select").disabled);
  }

  function keep() {
    const transfer = new DataTransfer();
    for (const file of chosen) transfer.items.add(file);
    input.files = transfer.files;
  }

  // ---- looking --------------------------------------------------------------------------------------------------
  async function inspect() {
    const turn = ++asked;
    const earlier = placements();
    clearProblem();
    if (again) again.hidden = true;
    if (!chosen.length) return show([], earlier, "");
    status.textContent = `Reading ${count(chosen.length)} …`;
    const data = new FormData();
    for (const file of chosen) data.append("files", file);
    let answer;
    try {
      await renew();
      const response = await fetch(area.dataset.inspect, {
        method: "POST",
        body: data,
        headers: { Accept: "application/json", "X-Form-Token": token.value },
      });
      answer = await response.json();
      if (turn !== asked) return;
      if (ended(response.status, answer)) answer = out("then choose the files again");
      if (!response.ok) return refuse(answer, earlier);
    } catch {
      if (turn === asked) refuse({ detail: "The server cannot be reached.", hint: "Check the connection, then choose the files again." }, earlier);
      return;
    }
    const wrong = answer.problems.filter((problem) => problem.file);
    const unread = wrong.map((problem) => ({ name: problem.file, unread: true }));
    show([...answer.files, ...unread], earlier, answer.problems.length ? "" : said(answer.files));
    for (const problem of answer.problems) tell(problem);
  }

  function refuse(problem, earlier) {
    show(chosen.map((file) => ({ name: file.name, unread: true })), earlier, "");
    tell(problem);
  }

  function said(files) {
    const open = files.filter((file) => !file.placement && !file.left_out).length;
    if (open) return `${count(files.length)} read. Say where ${open === 1 ? "one sensor was" : `${open} sensors were`} worn.`;
    return `${count(files.length)} read. Check where each sensor was worn.`;
  }

  function show(files, earlier, words) {
    rows.replaceChildren(...files.map((file, index) => row(file, index, earlier)));
    table.hidden = !files.length;
    status.textContent = words;
  }

  function row(file, index, earlier) {
    const made = rowTemplate.content.firstElementChild.cloneNode(true);
    made.dataset.file = file.name;
    made.querySelector("[data-name]").textContent = file.name;
    made.querySelector("[name=placed_name]").value = file.name;
    made.querySelector("[data-device]").textContent = file.device || "–";
    made.querySelector("[data-recorded]").textContent = recorded(file);
    const select = made.querySelector("select");
    select.id = `placed-${index}`;
    select.setAttribute("aria-label", `Placement of ${file.name}`);
    if (file.unread) {
      for (const control of made.querySelectorAll("[name]")) control.disabled = true;
      return withRemove(made, file);
    }
    const told = file.placement || (file.left_out ? "not_used" : "");
    select.value = earlier.get(file.name) || told;
    made.querySelector("[data-why]").textContent = select.value === told ? file.why : "";
    select.addEventListener("change", () => {
      made.querySelector("[data-why]").textContent = "";
    });
    return withRemove(made, file);
  }

  function withRemove(made, file) {
    if (!chosen.some((one) => one.name === file.name)) return made;
    const button = document.createElement("button");
    button.type = "button";
    button.className = "quiet small";
    button.textContent = "Remove";
    button.setAttribute("aria-label", `Remove ${file.name}`);
    button.addEventListener("click", () => {
      chosen = chosen.filter((one) => one.name !== file.name);
      keep();
      inspect();
      input.focus();
    });
    made.querySelector("th").append(" ", button);
    return made;
  }

  function recorded(file) {
    if (file.unread) return "not read";
    const parts = [];
    if (file.rate_hz) parts.push(`${(file.samples / file.rate_hz).toFixed(1)} s at ${Number(file.rate_hz.toFixed(1))} Hz`);
    else parts.push(`${file.samples} samples`);
    if (file.lost_share > 0) parts.push(`${(100 * file.lost_share).toFixed(1)} % lost`);
    return parts.join(", ");
  }

  function placements() {
    const found = new Map();
    for (const select of rows.querySelectorAll("select")) {
      const name = select.closest("tr").querySelector("[name=placed_name]").value;
      if (select.value) found.set(name, select.value);
    }
    return found;
  }

  // ---- course length follows the test, until it is typed -------------------------------------------------------------
  const test = form.querySelector("[data-test]");
  const course = form.elements.course_m;
  if (test && course) {
    const usual = () => test.selectedOptions[0].dataset.course;
    let ours = !course.value;
    if (ours) course.value = usual();
    course.addEventListener("input", () => {
      ours = course.value === "";
    });
    test.addEventListener("change", () => {
      if (ours) course.value = usual();
    });
  }

  // ---- sending --------------------------------------------------------------------------------------------------
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    if (submit.disabled) return;
    busy(true);
    clearProblem();
    await renew();
    const request = new XMLHttpRequest();
    request.open("POST", form.action);
    request.setRequestHeader("Accept", "application/json");
    request.responseType = "json";
    request.upload.addEventListener("progress", (step) => {
      if (!step.lengthComputable) return;
      progress.value = (100 * step.loaded) / step.total;
      sent.textContent = step.loaded < step.total ? `Sending, ${Math.round(progress.value)} %` : "Analysing …";
    });
    request.addEventListener("load", () => {
      if (request.status === 201) {
        window.location.assign(request.response.location);
        return;
      }
      if (ended(request.status, request.response)) {
        busy(false);
        tell(out("then press the button again"));
        return;
      }
      busy(false);
      tell(request.response || { detail: "The server refused the upload.", hint: "Try again." });
    });
    request.addEventListener("error", () => {
      busy(false);
      tell({ detail: "The connection broke off; nothing may have been stored.", hint: "Press the button again: the same walk is never stored twice." });
    });
    request.send(new FormData(form));
  });

  // The log-in has ended, or another one took its place in this browser.
  function ended(code, problem) {
    return code === 401 || (code === 403 && problem && problem.code === "form_token");
  }

  function out(next) {
    loggedOut = true;
    return { detail: "You were logged out.", hint: `Log in in another tab, ${next}. What you typed stays here.`, login: true };
  }

  // A form's token belongs to its log-in: after another log-in the page is asked for the new one.
  async function renew() {
    if (!loggedOut) return;
    try {
      const page = await (await fetch(window.location.href)).text();
      const fresh = new DOMParser().parseFromString(page, "text/html").querySelector("[data-session-form] [name=form_token]");
      if (!fresh) return;
      token.value = fresh.value;
      loggedOut = false;
    } catch {
      // Sending says that the server cannot be reached.
    }
  }

  window.addEventListener("pageshow", () => busy(false));

  function busy(on) {
    submit.disabled = on;
    sending.hidden = !on;
    progress.value = 0;
    sent.textContent = on ? "Sending …" : "";
  }

  // ---- saying what is wrong ---------------------------------------------------------------------------------------
  function clearProblem() {
    problemSlot.replaceChildren();
    for (const marked of form.querySelectorAll("[aria-invalid]")) marked.removeAttribute("aria-invalid");
    for (const marked of rows.querySelectorAll(".wrong")) marked.classList.remove("wrong");
  }

  function tell(problem) {
    const notice = noticeTemplate.content.firstElementChild.cloneNode(true);
    const where = [problem.file, problem.line && `line ${problem.line}`, problem.column && problem.file && `column ${problem.column}`];
    notice.querySelector("[data-place]").textContent = where.filter(Boolean).join(", ");
    notice.querySelector("[data-detail]").textContent = problem.detail || "Something went wrong.";
    notice.querySelector("[data-hint]").textContent = problem.hint || "";
    notice.querySelector("[data-way]").hidden = !problem.login;
    problemSlot.append(notice);
    const field = !problem.file && problem.column ? form.elements[problem.column] : null;
    if (field && field.setAttribute) {
      field.setAttribute("aria-invalid", "true");
      field.focus();
    }
    for (const one of rows.children) if (problem.file && one.dataset.file === problem.file) one.classList.add("wrong");
    problemSlot.scrollIntoView({ block: "nearest" });
  }

  function count(n) {
    return n === 1 ? "1 file" : `${n} files`;
  }

  if (chosen.length) inspect();
})();
