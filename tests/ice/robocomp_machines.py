"""A state machine as `rcyaml migrate` makes it of a .smdsl, and specific workers as users of RoboComp's own tool wrote
them for it, in both languages."""

MACHINE = """\
<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" name="patrolMachine" initial="initialize">
  <state id="initialize">
    <transition event="t_initialize_to_compute" target="compute"/>
  </state>
  <state id="compute">
    <transition event="t_compute_to_compute" target="compute"/>
    <transition event="t_compute_to_resting" target="resting"/>
  </state>
  <state id="resting" initial="still">
    <onentry><send event="t_resting_to_finalize" delay="50ms"/></onentry>
    <transition event="t_resting_to_finalize" target="finalize"/>
    <state id="still">
      <transition event="t_still_to_moving" target="moving"/>
    </state>
    <state id="moving"/>
  </state>
  <final id="finalize"/>
</scxml>
"""
EXPECTED = ["initialize", "turn 1", "turn 2", "turn 3", "resting", "still", "moving", "finalize"]

PYTHON = """
import threading

from genericworker import *


class SpecificWorker(GenericWorker):
    def __init__(self, proxy_map, startup_check=False):
        super(SpecificWorker, self).__init__(proxy_map)
        self.turns = 0
        self.Period = 20
        if startup_check:
            self.startup_check()
        else:
            self.timer.start(self.Period)
            self.patrolMachine.start()
            self.destroyed.connect(self.t_compute_to_resting)

    def setParams(self, params):
        return True

    def say(self, text):
        elsewhere = "" if threading.current_thread() is threading.main_thread() else " elsewhere"
        sys.stdout.write(f"> {text}{elsewhere}" + os.linesep)

    def startup_check(self):
        print("Startup check", flush=True)
        QtCore.QTimer.singleShot(200, QtCore.QCoreApplication.instance().quit)

    @QtCore.Slot()
    def compute(self):
        self.turns += 1
        self.say(f"turn {self.turns}")
        if self.turns == 3:
            threading.Thread(target=self.t_compute_to_resting.emit).start()
        return True

    @QtCore.Slot()
    def sm_initialize(self):
        self.say("initialize")
        self.initializetocompute.emit()  # the older name

    @QtCore.Slot()
    def sm_compute(self):
        if self.turns < 3:
            self.compute()

    @QtCore.Slot()
    def sm_resting(self):
        self.say("resting")

    @QtCore.Slot()
    def sm_still(self):
        self.say("still")
        self.t_still_to_moving.emit()

    @QtCore.Slot()
    def sm_moving(self):
        self.say("moving")

    @QtCore.Slot()
    def sm_finalize(self):
        self.say("finalize")
"""

HEADER = """
#ifndef SPECIFICWORKER_H
#define SPECIFICWORKER_H

#include <genericworker.h>

class SpecificWorker : public GenericWorker
{
Q_OBJECT
public:
	SpecificWorker(TuplePrx tprx, bool startup_check);
	~SpecificWorker();
	bool setParams(RoboCompCommonBehavior::ParameterList params);

public slots:
	void compute();
	int startup_check();
	void initialize(int period);
	//Specification slot methods State Machine
	void sm_initialize();
	void sm_compute();
	void sm_resting();
	void sm_still();
	void sm_moving();
	void sm_finalize();
private:
	void say(const std::string &text);
	std::thread::id main;
	bool startup_check_flag;
	int turns;
};

#endif
"""

SOURCE = """
#include "specificworker.h"

SpecificWorker::SpecificWorker(TuplePrx tprx, bool startup_check) : GenericWorker(tprx)
{
	this->startup_check_flag = startup_check;
	this->main = std::this_thread::get_id();
	turns = 0;
}

SpecificWorker::~SpecificWorker()
{
	std::cout << "Destroying SpecificWorker" << std::endl;
	emit t_compute_to_resting();
}

bool SpecificWorker::setParams(RoboCompCommonBehavior::ParameterList params)
{
	Q_UNUSED(params);
	patrolMachine.start();
	return true;
}

void SpecificWorker::initialize(int period)
{
	this->Period = period;
	if(this->startup_check_flag)
		this->startup_check();
	else
		timer.start(Period);
}

void SpecificWorker::say(const std::string &text)
{
	std::cout << "> " << text << (std::this_thread::get_id() == main ? "" : " elsewhere") << std::endl;
}

void SpecificWorker::compute()
{
	turns++;
	say("turn " + std::to_string(turns));
	if (turns == 3)
		std::thread([this] { emit t_compute_to_resting(); }).detach();
}

int SpecificWorker::startup_check()
{
	std::cout << "Startup check" << std::endl;
	QTimer::singleShot(200, qApp, SLOT(quit()));
	return 0;
}

void SpecificWorker::sm_initialize()
{
	say("initialize");
	emit this->initializetocompute(); // the older name
}

void SpecificWorker::sm_compute()
{
	if (turns < 3)
		compute();
}

void SpecificWorker::sm_resting()
{
	say("resting");
}

void SpecificWorker::sm_still()
{
	say("still");
	emit t_still_to_moving();
}

void SpecificWorker::sm_moving()
{
	say("moving");
}

void SpecificWorker::sm_finalize()
{
	say("finalize");
}
"""
