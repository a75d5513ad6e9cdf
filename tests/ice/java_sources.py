"""The components that the tests of Java build: documents, and the user's part of each."""

from __future__ import annotations

from scenario import INTERFACES, cdsl

DOCUMENTS = {
    **INTERFACES,
    "server/server.cdsl.yaml": cdsl("Server", "java", implements=["Arm", "Hand"], period="40 ms"),
    "client/client.cdsl.yaml": cdsl(
        "Client",
        "java",
        requires=[
            "Arm",
            {"Arm2": {"interface": "Arm", "absent": "fail"}},
            {"Hand": {"interface": "Hand", "absent": "ignore"}},
            {"Late": {"interface": "Arm", "timeout": "500 ms"}},
        ],
    ),
    "radio/radio.cdsl.yaml": cdsl(
        "Radio",
        "java",
        implements=["Arm"],
        requires=[{"Hand": {"interface": "Hand", "timeout": "30 s"}}],
        publishes=["ArmEvents"],
        subscribes=["ArmEvents"],
    ),
}

SERVER = """
import generated.GenericWorker;
import java.util.Map;
import slice.RoboCompArm.Arm;
import slice.RoboCompArm.Blocked;
import slice.RoboCompTypes.Pose;
import slice.RoboCompTypes.Side;

public class SpecificWorker extends GenericWorker {
    private int turns;

    @Override
    public void compute() {
        if (++turns == 3) {
            throw new IllegalStateException("the third one fails");
        }
        if (turns < 6) {
            System.out.println("turn " + turns + " " + getPeriod());
        }
    }

    @Override
    public int Arm_move(Pose[] path, boolean fast) throws Blocked {
        if (fast) {
            throw new Blocked(path[0], 9.5f);
        }
        return path.length;
    }

    @Override
    public Arm.StateResult Arm_state() {
        return new Arm.StateResult(Side.right, new Pose(1, 2, Side.left), Map.of("home", new Pose(3, 4, Side.left)));
    }

    @Override
    public void Arm_breakDown() {
        System.out.println(1 / (turns - turns));
    }

    @Override
    public void Arm_betray() {
        throw new UnsupportedOperationException("Broken");
    }

    @Override
    public void Arm_block(float seconds) {
        log.info("blocking");
        try {
            Thread.sleep((long) (seconds * 1000));
        } catch (InterruptedException error) {
            Thread.currentThread().interrupt();
        }
    }

    @Override
    public byte[] Hand_grasp(byte[] image) {
        byte[] turned = new byte[image.length];
        for (int place = 0; place < image.length; place++) {
            turned[place] = image[image.length - 1 - place];
        }
        return turned;
    }
}
"""
CLIENT = """
import generated.GenericWorker;
import slice.RoboCompArm.Arm;
import slice.RoboCompArm.Blocked;
import slice.RoboCompArm.Broken;
import slice.RoboCompTypes.Pose;
import slice.RoboCompTypes.Side;

public class SpecificWorker extends GenericWorker {
    private interface Call {
        void make() throws Broken;
    }

    @Override
    public void initialize() throws Exception {
        Pose[] path = {new Pose(1, 2, Side.left), new Pose()};
        System.out.println("move " + arm_proxy.move(path, false) + " " + arm2_proxy.move(new Pose[0], false));
        Arm.StateResult state = arm_proxy.state();
        System.out.println("state " + state.returnValue + " " + state.pose.y + " " + state.named.size() + " "
            + state.named.get("home").x);
        try {
            arm_proxy.move(path, true);
        } catch (Blocked blocked) {
            System.out.println("blocked at " + blocked.where.x + " " + blocked.force);
        }
        for (Call call : new Call[] {arm_proxy::breakDown, arm_proxy::betray}) {
            try {
                call.make();
            } catch (com.zeroc.Ice.UnknownException problem) {
                System.out.println("unknown: " + problem.unknown);
            }
        }
        try {
            late_proxy.block(3);
        } catch (com.zeroc.Ice.InvocationTimeoutException late) {
            System.out.println("timed out");
        }
        System.out.println("grasp " + new String(hand_proxy.grasp("abc".getBytes())));
    }
}
"""
RADIO = """
import generated.GenericWorker;
import slice.RoboCompTypes.Pose;
import slice.RoboCompTypes.Side;
import slice.RoboCompArm.Arm;

public class SpecificWorker extends GenericWorker {
    private int value;
    private int counted;

    @Override
    public void initialize() throws Exception {
        value = 1;
        armevents_pubproxy.moved(new Pose(4, 2.5f, Side.right));
        for (int n = 0; n < 100; n++) {
            armevents_pubproxy.count(n);
        }
        System.out.println("published");
    }

    @Override
    public void ArmEvents_moved(Pose pose) {
        System.out.println("moved to " + pose.x + " " + pose.side);
    }

    @Override
    public synchronized void ArmEvents_count(int n) {
        if (n != counted++) {
            System.out.println("expected " + (counted - 1) + ", got " + n);
        }
        if (counted == 100) {
            System.out.println("all in order");
        }
    }

    @Override
    public int Arm_move(Pose[] path, boolean fast) {
        return value;
    }

    @Override
    public Arm.StateResult Arm_state() {
        return new Arm.StateResult();
    }

    @Override
    public void Arm_breakDown() {
        killYourSelf();
    }

    @Override
    public void Arm_betray() {
    }

    @Override
    public void Arm_block(float seconds) {
    }
}
"""
SOURCES = {"Server": SERVER, "Client": CLIENT, "Radio": RADIO}
