"""Networks made by hand: a small one with everything in it, and large ones."""

from __future__ import annotations

from msgspec.structs import replace

from robocomp_yaml.network.network import (
    CONFIG,
    ICESTORM,
    LOOPBACK,
    NEVER,
    PROGRAM,
    TOPIC,
    ConfigFile,
    Connection,
    Endpoint,
    EnvironmentVariable,
    Network,
    NetworkHost,
    Process,
    Readiness,
    RestartRule,
)


def served(interface: str, port: int) -> Endpoint:
    return Endpoint(interface, interface.lower(), port, f"tcp -p {port}", module=f"RoboComp{interface}")


def speaking(folder: str = "/robot/.rcyaml/deployments/Head") -> Network:
    """Two hosts, IceStorm, three components, a program with a second name and one that is not started."""
    network = Network("Head", "/robot/head.ddsl.yaml", folder, {
        "onboard": NetworkHost("onboard", "10.0.0.2"), "head": NetworkHost("head", "10.0.0.3", "robocomp"),
    })  # fmt: skip

    def component(name: str, host: str, ports: tuple[Endpoint, ...], after: tuple[str, ...] = (),
                  env: tuple[EnvironmentVariable, ...] = ()) -> Process:  # fmt: skip
        config = ConfigFile(f"config/{name}", f"Title=50% ${{env:TITLE}} of $HOME & <{name}>\n")
        return Process(
            name,
            host,
            (f"/robot/{name}/bin/{name}", CONFIG),
            f"/robot/{name}",
            config=config,
            endpoints=ports,
            after=after,
            env=env,
            component=name.capitalize(),
            ready=Readiness(5.0, (f"{name}:tcp -p 1",)),
        )

    storm = Process(
        "storm", "onboard", ("icebox", f"--Ice.Config={CONFIG}"), folder, ICESTORM,
        config=ConfigFile("config/storm", "IceBox.InheritProperties=1\n"),
        endpoints=(Endpoint("TopicManager", "IceStorm/TopicManager", 9999, "tcp -p 9999", module="IceStorm"),),
        folders=(f"{folder}/state/storm",),
    )  # fmt: skip
    laser = Process(
        "laser", "onboard", ("rcis", "a b;c", ";", "$HOME", "100%", 'say "hi"', "back\\slash"), "/robot/etc sim",
        PROGRAM, env=(EnvironmentVariable("DISPLAY", ":0"), EnvironmentVariable("TOKEN", source="ROBOT_TOKEN")),
        endpoints=(served("Laser", 10003), served("DifferentialRobot", 10004)), aliases=("base",), is_ice=False,
        restart=RestartRule(NEVER),
    )  # fmt: skip
    viewer = Process("viewer", "head", ("/usr/bin/viewer",), "", PROGRAM, enabled=False, is_ice=False)
    processes = (
        storm, laser, component("motors", "head", (served("JointMotor", 10005),)),
        component("mouth", "head", (served("Mouth", 10002),), ("motors", "storm")),
        component("speech", "onboard", (served("Speech", 10001),), ("mouth", "storm"), (EnvironmentVariable("LANG", "es_ES"),)),
        viewer,
    )  # fmt: skip
    connections = (
        Connection("mouth", "JointMotor", "JointMotor", "motors"),
        Connection("speech", "Mouth", "Mouth", "mouth"),
        Connection("speech", "SpeechEvents", "SpeechEvents", "storm", TOPIC, "robot1/SpeechEvents", is_out=True),
        Connection("mouth", "SpeechEvents", "SpeechEvents", "storm", TOPIC, "robot1/SpeechEvents"),
        Connection("speech", "Camera", "Camera", "", proxy="camera:tcp -h 10.0.0.9 -p 10100"),
    )
    order = (("storm", "laser", "motors"), ("mouth",), ("speech",))
    by_name = {process.name: process for process in processes}
    return replace(network, processes=by_name, connections=connections, order=order)


def large(count: int, hosts: int = 4) -> Network:
    """Robots that look alike: each component needs the one before it in its row and one of another row."""
    network = Network("Fleet", "/fleet.ddsl.yaml", "/f", {
        f"robot{i}": NetworkHost(f"robot{i}", f"10.0.0.{i + 1}") for i in range(hosts)
    } if hosts > 1 else {LOOPBACK: NetworkHost(LOOPBACK)})  # fmt: skip
    names, connections = list(network.hosts), []
    for i in range(count):
        name = f"component{i}"
        after: tuple[str, ...] = ()
        for other in {i - 1 if i % 7 else -1, i // 3 if i % 5 == 1 else -1}:
            if 0 <= other < i:
                after += (f"component{other}",)
                connections.append(Connection(name, f"Port{other}", f"Interface{other}", f"component{other}"))
        network.processes[name] = Process(
            name, names[i * hosts // count], (f"/fleet/bin/{name}",), "/fleet", after=after,
            endpoints=(served(f"Interface{i}", 10000 + i),),
        )  # fmt: skip
    depth: dict[str, int] = {}
    for process in network.processes.values():
        depth[process.name] = 1 + max((depth[other] for other in process.after), default=-1)
    order = []
    for level in range(max(depth.values(), default=-1) + 1):
        order.append(tuple(name for name, at in depth.items() if at == level))
    return replace(network, connections=tuple(connections), order=tuple(order))
