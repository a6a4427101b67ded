export function startPicker() {}
