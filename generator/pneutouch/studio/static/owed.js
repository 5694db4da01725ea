// A request that has to be sent again when the user comes back to this page from another one.

export class Owed {
  constructor() {
    this.send = null;
    window.addEventListener("focus", () => this.settle());
  }

  settle() {
    const { send } = this;
    this.send = null;
    send?.();
  }
}
