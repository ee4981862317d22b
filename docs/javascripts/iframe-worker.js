// Search of a site that is opened from a folder: browsers start no worker there, so a hidden frame
// does its work. Its name is the one by which the offline plugin knows that nothing is to be fetched.
if (location.protocol === "file:") {
  const inFrame = (url) => `<script>
    const toItself = self.postMessage.bind(self);
    self.postMessage = (data, ...rest) =>
      rest.length ? toItself(data, ...rest) : parent.postMessage(data, "*");
  </script><script src="${url}"></script>`;

  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.createElement("iframe");
      frame.hidden = true;
      frame.srcdoc = inFrame(new URL(url, location.href));
      this.frame = frame;
      this.ready = new Promise((resolve) => frame.addEventListener("load", resolve));
      window.addEventListener("message", ({ source, data }) => {
        if (source === frame.contentWindow) this.dispatchEvent(new MessageEvent("message", { data }));
      });
      document.body.append(frame);
    }

    postMessage(data) {
      this.ready.then(() => this.frame.contentWindow.postMessage(data, "*"));
    }

    terminate() {
      this.frame.remove();
    }
  };
}
