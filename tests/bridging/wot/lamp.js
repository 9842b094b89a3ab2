// A Thing by node-wot, the implementation of the Eclipse project Thingweb, for tests/bridging/wot/test_node_wot.py.
const { Servient } = require("@node-wot/core");
const { HttpServer } = require("@node-wot/binding-http");

const port = Number(process.argv[2]);
const servient = new Servient();
servient.addServer(new HttpServer({ port, address: "127.0.0.1", baseUri: `http://127.0.0.1:${port}` }));

servient.start().then(async (WoT) => {
    let on = false;
    let turns = 0;
    let blinks = 0;
    const boolean = { "@type": "rob:Switch", type: "boolean" };
    const thing = await WoT.produce({
        "@context": [
            "https://www.w3.org/2019/wot/td/v1",
            "https://www.w3.org/2022/wot/td/v1.1",
            { rob: "https://w3id.org/selfconf/robotics#" },
        ],
        id: "urn:thing:lamp",
        title: "Lamp",
        "@type": "rob:Lamp",
        properties: {
            on: { ...boolean, observable: true },
            turns: { type: "integer", readOnly: true, observable: true },
            blinks: { type: "integer", readOnly: true },
        },
        actions: { blink: { input: { "@type": "rob:Switch", type: "boolean" } } },
        events: { flicker: { data: { type: "integer" } } },
    });
    thing.setPropertyReadHandler("on", async () => on);
    thing.setPropertyWriteHandler("on", async (value) => {
        on = await value.value();
        thing.emitPropertyChange("on");
    });
    thing.setPropertyReadHandler("turns", async () => turns);
    thing.setPropertyReadHandler("blinks", async () => blinks);
    thing.setActionHandler("blink", async () => {
        blinks += 1;
    });
    await thing.expose();
    setInterval(() => {
        turns += 1;
        thing.emitPropertyChange("turns");
        thing.emitEvent("flicker", turns);
    }, 100);
    console.log("exposed");
});
