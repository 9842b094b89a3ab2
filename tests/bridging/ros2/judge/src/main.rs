//! Nodes of ROS 2 by hiroz, each in a process of its own: `judge ENDPOINT DOMAIN ROLE [NAME]`.
//!
//! What a role hears, answers and sees goes to standard output, a line each, for the test that has started it.

use std::{collections::BTreeSet, env, future::pending, time::Duration};

use hiroz::{
    Builder, Result,
    action::server::{Executing, GoalHandle},
    context::{ZContext, ZContextBuilder},
    entity::EndpointKind,
    qos::{QosDurability, QosProfile},
};
use hiroz_msgs::{
    action_tutorials_interfaces::{FibonacciFeedback, FibonacciResult, action::Fibonacci},
    example_interfaces::{AddTwoIntsRequest, AddTwoIntsResponse, srv::AddTwoInts},
    rosbag2_interfaces::{SetRateResponse, srv::SetRate},
    std_msgs::String as Text,
};
use hiroz_protocol::KeyExprFormat;
use tokio::time::sleep;

const PAUSE: Duration = Duration::from_millis(100);
/// The role that counts does not come to the end of a goal from this number on.
const ENDLESS: i32 = 100;

fn text(data: impl Into<String>) -> Text {
    Text { data: data.into() }
}

/// Publishes ten texts a second on `/NAME/one`.
async fn talk(context: &ZContext, name: &str) -> Result<()> {
    let node = context.create_node(name).build()?;
    let publisher = node.create_pub::<Text>(&format!("/{name}/one")).build()?;
    for number in 0.. {
        publisher
            .async_publish(&text(format!("judge {number}")))
            .await?;
        sleep(PAUSE).await;
    }
    Ok(())
}

/// Publishes one text on `/map`, once and for those that are subscribed later as well.
async fn map(context: &ZContext) -> Result<()> {
    let node = context.create_node("mapper").build()?;
    let kept = QosProfile {
        durability: QosDurability::TransientLocal,
        ..Default::default()
    };
    let publisher = node.create_pub::<Text>("/map").with_qos(kept).build()?;
    publisher.async_publish(&text("the map")).await?;
    pending().await
}

/// Hears texts on `/two`.
async fn listen(context: &ZContext) -> Result<()> {
    let node = context.create_node("listener").build()?;
    let subscription = node.create_sub::<Text>("/two").build()?;
    loop {
        println!("heard {}", subscription.async_recv().await?.data);
    }
}

/// Serves `/three`, which adds two numbers.
async fn serve(context: &ZContext) -> Result<()> {
    let node = context.create_node("server").build()?;
    let mut service = node.create_service::<AddTwoInts>("/three").build()?;
    loop {
        let request = service.async_take_request().await?;
        let sum = request.message().a + request.message().b;
        request.reply(&AddTwoIntsResponse { sum }).await?;
    }
}

/// Calls `/four` until it is answered, and says by what.
async fn ask(context: &ZContext) -> Result<()> {
    let node = context.create_node("client").build()?;
    let client = node.create_client::<AddTwoInts>("/four").build()?;
    let request = AddTwoIntsRequest { a: 40, b: 2 };
    loop {
        if let Ok(answer) = client
            .call_with_timeout(&request, Duration::from_secs(2))
            .await
        {
            println!("answered {}", answer.sum);
        }
        sleep(PAUSE).await;
    }
}

/// Serves `/set_rate`, whose type selfconf does not know by itself; any rate but zero will do.
async fn play(context: &ZContext) -> Result<()> {
    let node = context.create_node("player").build()?;
    let mut service = node.create_service::<SetRate>("/set_rate").build()?;
    loop {
        let request = service.async_take_request().await?;
        let success = request.message().rate != 0.0;
        request.reply(&SetRateResponse { success }).await?;
    }
}

/// Serves the action `/count`, which has feedback: polls for what is to be cancelled, as hiroz does not look for that
/// while a client waits for a result if it drives the server itself (`with_handler`).
async fn act(context: &ZContext) -> Result<()> {
    let node = context.create_node("counter").build()?;
    let server = node.create_action_server::<Fibonacci>("/count").build()?;
    loop {
        let goal = server.recv_goal().await?;
        if goal.goal().order < -1 {
            goal.reject()?;
        } else {
            tokio::spawn(count(goal.accept().execute()));
        }
    }
}

async fn count(goal: GoalHandle<Fibonacci, Executing>) -> Result<()> {
    let order = goal.goal().order;
    let mut sequence = vec![0, 1];
    if order < 0 {
        return goal.abort(FibonacciResult { sequence });
    }
    while order >= ENDLESS || sequence.len() < order as usize {
        if goal.try_process_cancel() {
            println!("canceled {order}");
            return goal.canceled(FibonacciResult { sequence });
        }
        if order < ENDLESS {
            sequence.push(sequence[sequence.len() - 2] + sequence[sequence.len() - 1]);
        }
        goal.publish_feedback(FibonacciFeedback {
            partial_sequence: sequence.clone(),
        })?;
        sleep(PAUSE).await;
    }
    goal.succeed(FibonacciResult { sequence })
}

/// A lifecycle node that says each state that it comes into.
async fn live(context: &ZContext) -> Result<()> {
    let node = context.create_lifecycle_node("managed").build()?;
    let mut before = None;
    loop {
        let state = node.get_current_state();
        if before.replace(state) != Some(state) {
            println!("{}", state.label());
        }
        sleep(PAUSE).await;
    }
}

/// Says which nodes publish and serve what in the domain, each line once, as they come.
async fn look(context: &ZContext) -> Result<()> {
    let _node = context.create_node("observer").build()?;
    let graph = context.graph();
    let mut told = BTreeSet::new();
    loop {
        for (name, namespace) in graph.get_node_names() {
            let namespace = if namespace == "/" {
                String::new()
            } else {
                namespace
            };
            for (kind, verb) in [
                (EndpointKind::Publisher, "publishes"),
                (EndpointKind::Service, "serves"),
            ] {
                for (what, _) in
                    graph.get_names_and_types_by_node((namespace.clone(), name.clone()), kind)
                {
                    if told.insert((name.clone(), verb, what.clone())) {
                        println!("{name} {verb} {what}");
                    }
                }
            }
        }
        sleep(PAUSE).await;
    }
}

#[tokio::main]
async fn main() -> Result<()> {
    let given: Vec<String> = env::args().skip(1).collect();
    let [endpoint, domain, role, name @ ..] = given.as_slice() else {
        return Err("usage: judge ENDPOINT DOMAIN ROLE [NAME]".into());
    };
    let context = ZContextBuilder::default()
        .with_mode("client")
        .with_connect_endpoints([endpoint.as_str()])
        .disable_multicast_scouting()
        .with_domain_id(domain.parse()?)
        .keyexpr_format(KeyExprFormat::RmwZenoh)
        .build()?;
    match role.as_str() {
        "talker" => talk(&context, name.first().map_or("talker", String::as_str)).await,
        "mapper" => map(&context).await,
        "listener" => listen(&context).await,
        "server" => serve(&context).await,
        "client" => ask(&context).await,
        "player" => play(&context).await,
        "counter" => act(&context).await,
        "managed" => live(&context).await,
        "observer" => look(&context).await,
        other => Err(format!("{other} is no role").into()),
    }
}
