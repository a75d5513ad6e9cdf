"""Specific workers as users of RoboComp's own tool write them, for the tests: two generations of Python.

The server implements two interfaces and publishes a topic; the client requires them and subscribes to it. Both read
parameters.
"""

# In place of PySide6, where there is none.
NO_QT = 'raise ModuleNotFoundError("No module named \'PySide6\'", name="PySide6")\n'

SERVER_2023 = '''
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from genericworker import *
import interfaces as ifaces

sys.path.append("/opt/robocomp/lib")


class SpecificWorker(GenericWorker):
    def __init__(self, proxy_map, startup_check=False):
        super(SpecificWorker, self).__init__(proxy_map)
        self.Period = 20
        self.turns = 0
        if startup_check:
            self.startup_check()
        else:
            self.timer.timeout.connect(self.compute)
            self.timer.start(self.Period)

    def __del__(self):
        """Destructor"""

    def setParams(self, params):
        self.limit = int(params["Limits.Force"])
        self.owner = params["Owner"]
        return True

    @QtCore.Slot()
    def compute(self):
        self.turns += 1
        if self.turns == 1:
            print("first turn in", os.path.basename(os.getcwd()), "limit", self.limit, "of", self.owner, flush=True)
        self.armevents_proxy.count(self.turns)
        if self.turns % 7 == 0:
            1 / 0
        return True

    def startup_check(self):
        path = ifaces.RoboCompTypes.Path()
        path.append(ifaces.RoboCompTypes.Pose())
        print("checked", len(path), isinstance(path, list), flush=True)
        QTimer.singleShot(200, QApplication.instance().quit)

    def Arm_move(self, path, fast):
        if fast:
            raise ifaces.RoboCompArm.Blocked(path[0], float(self.limit))
        locker = QtCore.QMutexLocker(self.mutex)
        return len(path)

    def Arm_state(self):
        pose = ifaces.RoboCompTypes.Pose(x=self.turns, y=8, side=ifaces.RoboCompTypes.Side.left)
        return [ifaces.RoboCompTypes.Side.right, pose, {"home": pose}]

    def Arm_breakDown(self):
        self.setPeriod(500)

    def Arm_betray(self):
        self.killYourSelf()

    def Hand_grasp(self, image):
        return image[::-1]
'''

SERVER_2020 = """
import sys, os, traceback, time
from PySide2 import QtCore
from PySide2.QtCore import QMutex, QMutexLocker
from genericworker import *


class SpecificWorker(GenericWorker):
	hurry = QtCore.Signal(int)

	def __init__(self, proxy_map):
		super(SpecificWorker, self).__init__(proxy_map)
		self.timer.timeout.connect(self.compute)
		self.Period = 20
		self.timer.start(self.Period)
		self.turns = 0
		self.own = QMutex()
		self.hurry.connect(self.hurried)

	def setParams(self, params):
		try:
			self.limit = int(params["Limits.Force"])
			print("of", params["Owner"])
		except:
			traceback.print_exc()
			return False

	@QtCore.Slot()
	def compute(self):
		self.turns += 1
		self.mutex.lock()
		self.mutex.lock()
		if self.turns == 1:
			print("first turn in", os.path.basename(os.getcwd()), "limit", self.limit)
			sys.stdout.flush()
		self.mutex.unlock()
		self.mutex.unlock()
		self.armevents_proxy.count(self.turns)

	@QtCore.Slot(int)
	def hurried(self, n):
		print("hurried", n, QtCore.QThread.currentThread() is not None if hasattr(QtCore, "QThread") else True)
		sys.stdout.flush()

	def Arm_move(self, path, fast):
		if fast:
			raise Blocked(path[0], float(self.limit))
		with QMutexLocker(self.own):
			self.hurry.emit(len(path))
		return len(path)

	def Arm_state(self):
		return (RoboCompTypes.Side.right, Pose(self.turns, 8, Side.left), {"home": Pose()})

	def Arm_breakDown(self):
		self.setPeriod(500)

	def Arm_betray(self):
		self.kill.emit()

	def grasp(self, image):
		return image[::-1]
"""

CLIENT_2025 = """
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from genericworker import *
import interfaces as ifaces


class SpecificWorker(GenericWorker):
    def __init__(self, proxy_map, configData, startup_check=False):
        super(SpecificWorker, self).__init__(proxy_map, configData)
        self.Period = configData["Period"]["Compute"]
        self.counts = []
        self.done = False
        print("configured", self.Period, configData["Limits"]["Force"] + 1, configData["Owner"], configData["Fast"])
        if startup_check:
            self.startup_check()
        else:
            self.timer.timeout.connect(self.compute)
            self.timer.start(self.Period)

    @QtCore.Slot()
    def compute(self):
        if self.done or len(self.counts) < 3:
            return
        self.done = True
        path = [ifaces.RoboCompTypes.Pose(1, 2), ifaces.RoboCompTypes.Pose(x=7)]
        print("move", self.arm_proxy.move(path, False), self.arm2_proxy.move(ifaces.RoboCompTypes.Path(path[:1]), False))
        side, pose, named = self.arm_proxy.state()
        print("state", side, pose.y, list(named))
        print("grasp", self.hand_proxy.grasp(b"abc"))
        try:
            self.arm_proxy.move(path, True)
        except ifaces.RoboCompArm.Blocked as blocked:
            print("blocked at", blocked.where.x, blocked.force)
        self.arm_proxy.breakDown()
        print("that is all", flush=True)

    def startup_check(self):
        QTimer.singleShot(200, QApplication.instance().quit)

    def ArmEvents_moved(self, pose):
        pass

    def ArmEvents_count(self, n):
        self.counts.append(n)
"""
