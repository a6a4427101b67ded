// Requests to the program that served the page; their addresses are relative, so they carry its token.

async function answer(request) {
  let reply;
  try {
    reply = await request;
  } catch {
    throw new Error("The program behind this page does not answer; it was probably stopped.");
  }
  const body = await reply.json();
  if (!reply.ok && reply.status !== 409) throw new Error(body.error ?? `The program answered ${reply.status}.`);
  return { status: reply.status, body };
}

export const ask = (name) => answer(fetch(name, { cache: "no-store" }));

export const tell = (name, data) => answer(fetch(name, {
  method: "POST",
  headers: { "Content-Type": "application/json" },
  body: JSON.stringify(data),
}));
