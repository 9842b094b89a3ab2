// A client by node-wot, the implementation of the Eclipse project Thingweb, that reads a directory of Things, for
// tests/serve/test_foreign_clients.py: node directory_client.js URL. It says what it has found, as JSON.
const { Servient } = require("@node-wot/core");
const { HttpClientFactory } = require("@node-wot/binding-http");

const servient = new Servient();
servient.addClientFactory(new HttpClientFactory());

servient.start().then(async (WoT) => {
    const introduction = `${process.argv[2]}.well-known/wot`;
    const directory = await WoT.consume(await WoT.requestThingDescription(introduction));
    const things = (await (await directory.readProperty("things")).value()).map((thing) => thing.id);
    const explored = [];
    for await (const description of await WoT.exploreDirectory(introduction)) {
        explored.push((await WoT.consume(description)).getThingDescription().title);
    }
    const one = await directory.invokeAction("retrieveThing", undefined, { uriVariables: { id: things[0] } });
    console.log(JSON.stringify({ things, explored, retrieved: (await one.value()).id }));
    await servient.shutdown();
});
