"""The C++ components with Qt that the tests build: windows, and specific workers for RoboComp's own tool, in three
generations."""

from __future__ import annotations

from forms import FORM
from scenario import INTERFACES, cdsl

_ROBOCOMP = {"compatibility": "robocomp"}

DOCUMENTS = {
    **INTERFACES,
    "window/window.cdsl.yaml": cdsl(
        "Window", "cpp", gui={"toolkit": "qt", "base": "QMainWindow"}, implements=["Arm"], period="20 ms"
    ),
    "dialog/dialog.cdsl.yaml": cdsl("Dialog", "cpp", gui={"toolkit": "qt", "base": "QDialog"}),
    "old/old.cdsl.yaml": cdsl("Old", "cpp", implements=["Arm", "Hand"], publishes=["ArmEvents"], **_ROBOCOMP),
    "new/new.cdsl.yaml": cdsl("New", "cpp", implements=["Arm", "Hand"], publishes=["ArmEvents"], **_ROBOCOMP),
    "latest/latest.cdsl.yaml": cdsl(
        "Latest", "cpp", requires=["Arm", {"Arm2": "Arm"}, "Hand"], subscribes=["ArmEvents"], **_ROBOCOMP
    ),
    "face/face.cdsl.yaml": cdsl("Face", "cpp", gui={"toolkit": "qt", "base": "QWidget"}, **_ROBOCOMP),
    "bare/bare.cdsl.yaml": cdsl(
        "Bare", "cpp", implements=["Arm"], requires=["Hand"], subscribes=["ArmEvents"], **_ROBOCOMP
    ),
}

WINDOW_H = """
#pragma once

#include "genericworker.h"

#include <QTimer>

#include <atomic>
#include <thread>

class SpecificWorker : public GenericWorker
{
public:
    void initializeGui() override;
    void initialize() override;
    void compute() override;
    int Arm_move(const RoboCompTypes::Path& path, bool fast) override;
    RoboCompTypes::Side Arm_state(RoboCompTypes::Pose&, RoboCompTypes::Named&) override { return {}; }
    void Arm_breakDown() override {}
    void Arm_betray() override {}
    void Arm_block(float) override {}

private:
    void work(int n);

    std::thread::id main_ = std::this_thread::get_id();
    std::thread::id worker_;
    QTimer ticking_;
    std::atomic_int ticks_{0};
    int turns_ = 0;
};
"""

WINDOW = """
#include "specificworker.h"

#include <QLabel>
#include <QPushButton>

#include <iostream>
#include <stdexcept>

void SpecificWorker::initializeGui()
{
    QObject::connect(&ticking_, &QTimer::timeout, [this] { ++ticks_; });
    ticking_.start(10);
    QObject::connect(
        ui.button, &QPushButton::clicked,
        [this]
        {
            std::cout << "clicked in main " << (std::this_thread::get_id() == main_) << std::endl;
            runInWorker([this] { work(7); });
        });
    std::cout << "window with " << ui.label->text().toStdString() << std::endl;
}

void SpecificWorker::initialize()
{
    worker_ = std::this_thread::get_id();
    std::cout << "initialize elsewhere " << (worker_ != main_) << std::endl;
}

void SpecificWorker::work(int n)
{
    std::cout << "work " << n << " in worker " << (std::this_thread::get_id() == worker_) << std::endl;
    runInGui([this, n] { ui.label->setText(QString("worked %1").arg(n)); });
    runInGui([this] { std::cout << "label says " << ui.label->text().toStdString() << std::endl; });
    runInGui([] { throw std::domain_error("in the window"); });
    runInWorker([] { throw std::domain_error("in between"); });
}

void SpecificWorker::compute()
{
    ++turns_;
    if (turns_ == 1)
    {
        runInGui([this] { ui.button->click(); });
    }
    else if (turns_ == 2)
    {
        const int before = ticks_;
        std::this_thread::sleep_for(std::chrono::milliseconds(500)); // the window must answer meanwhile
        std::cout << "ticks while it worked: " << ticks_ - before << std::endl;
        for (int n = 0; n < 2000; ++n)
        {
            runInGui([this, n] { ui.label->setText(QString::number(n)); });
        }
        runInGui([this] { std::cout << "at last " << ui.label->text().toStdString() << std::endl; });
    }
}

int SpecificWorker::Arm_move(const RoboCompTypes::Path&, bool)
{
    runInGui([this] { window.close(); });
    return 1;
}
"""

DIALOG = """
#include "specificworker.h"

void SpecificWorker::initializeGui() {}
void SpecificWorker::initialize() {}

void SpecificWorker::compute()
{
    runInGui([this] { window.reject(); });
}
"""

OLD_H = """
#ifndef SPECIFICWORKER_H
#define SPECIFICWORKER_H

#include <genericworker.h>

class SpecificWorker : public GenericWorker
{
Q_OBJECT
public:
	SpecificWorker(MapPrx& mprx, bool startup_check);
	~SpecificWorker();
	bool setParams(RoboCompCommonBehavior::ParameterList params);

	int Arm_move(const Path &path, const bool fast);
	RoboCompTypes::Side state(RoboCompTypes::Pose &pose, Named &named);
	void breakDown();
	void Arm_betray();
	Image grasp(const Image &image);

public slots:
	void compute();
	int startup_check();
	void initialize(int period);
private:
	void Arm_block(const float seconds);
	vector<RoboCompArm::ArmEventsPrx> audience;
	bool startup_check_flag;
	int limit, turns;
	string owner;
	QColor colour;
};

#endif
"""

OLD = """
#include "genericworker.h"
#include "specificworker.h"

SpecificWorker::SpecificWorker(MapPrx& mprx, bool startup_check) : GenericWorker(mprx)
{
	this->startup_check_flag = startup_check;
	turns = 0;
	RoboCompArm::ArmEventsPrx first = armevents_proxy;
	audience.push_back(first);
	audience.push_back(RoboCompArm::ArmEventsPrx::uncheckedCast(mprx["armevents_pubproxy"]));
	rInfo("an audience of " + std::to_string(audience.size()));
	rDebug(QString("as RoboComp's log"));
}

SpecificWorker::~SpecificWorker()
{
	std::cout << "Destroying SpecificWorker" << std::endl;
}

bool SpecificWorker::setParams(RoboCompCommonBehavior::ParameterList params)
{
	try
	{
		RoboCompCommonBehavior::Parameter par = params.at("Force");
		limit = stoi(par.value);
		owner = params.at("Owner").value;
		colour = QColor(params.at("Colour").value.c_str());
	}
	catch(const std::exception &e) { qFatal("Error reading config params"); }
	return true;
}

void SpecificWorker::initialize(int period)
{
	this->Period = period;
	if(this->startup_check_flag)
	{
		this->startup_check();
	}
	else
	{
		timer.start(Period);
	}
}

void SpecificWorker::compute()
{
	QMutexLocker locker(mutex);
	turns++;
	if (turns == 1)
		cout << "first turn, period " << Period << " limit " << limit << " of " << owner << endl;
	try
	{
		audience[turns % 2]->count(turns);
	}
	catch(const Ice::Exception &e)
	{
		std::cout << "Error publishing " << e << std::endl;
	}
	if (turns % 7 == 0)
		throw std::domain_error("seven");
}

int SpecificWorker::startup_check()
{
	std::cout << "Startup check" << std::endl;
	QTimer::singleShot(200, qApp, SLOT(quit()));
	return 0;
}

int SpecificWorker::Arm_move(const Path &path, const bool fast)
{
	QMutexLocker locker(mutex);
	if (fast)
		throw RoboCompArm::Blocked(path.at(0), (float)limit);
	return path.size();
}

RoboCompTypes::Side SpecificWorker::state(RoboCompTypes::Pose &pose, Named &named)
{
	pose.x = turns;
	pose.y = 8;
	pose.side = RoboCompTypes::left;
	named["home"] = pose;
	return RoboCompTypes::right;
}

void SpecificWorker::breakDown()
{
	QMetaObject::invokeMethod(this, [this] { setPeriod(500); }, Qt::QueuedConnection);
}

void SpecificWorker::Arm_betray()
{
	killYourSelf();
}

void SpecificWorker::Arm_block(const float) {}

Image SpecificWorker::grasp(const Image &image)
{
	return Image(image.rbegin(), image.rend());
}
"""

MONITOR_H = """
#ifndef SPECIFICMONITOR_H
#define SPECIFICMONITOR_H

#include "genericmonitor.h"

class SpecificMonitor : public GenericMonitor
{
  Q_OBJECT

  public:
	SpecificMonitor(GenericWorker *_worker, Ice::CommunicatorPtr _communicator);
	~SpecificMonitor();

	void readConfig(RoboCompCommonBehavior::ParameterList &params );
	void run();
	void initialize();

	bool sendParamsToWorker(RoboCompCommonBehavior::ParameterList params);
	bool checkParams(RoboCompCommonBehavior::ParameterList l);

	bool ready;
};

#endif // GENERICMONITOR_H
"""

MONITOR = """
#include "specificmonitor.h"

SpecificMonitor::SpecificMonitor(GenericWorker *_worker,Ice::CommunicatorPtr _communicator):GenericMonitor(_worker, _communicator)
{
	ready = false;
}

SpecificMonitor::~SpecificMonitor()
{
	std::cout << "Destroying SpecificMonitor" << std::endl;
}

void SpecificMonitor::run()
{
	initialize();
	ready = true;
	forever
	{
		this->sleep(period);
	}
}

void SpecificMonitor::initialize()
{
	rInfo("Starting monitor ...");
	initialTime=QTime::currentTime();
	RoboCompCommonBehavior::ParameterList params;
	readPConfParams(params);
	readConfig(params);
	if(!sendParamsToWorker(params))
	{
		rError("Error reading config parameters. Exiting");
		killYourSelf();
	}
	state = RoboCompCommonBehavior::Running;
	emit initializeWorker(period);
}

bool SpecificMonitor::sendParamsToWorker(RoboCompCommonBehavior::ParameterList params)
{
	if(checkParams(params))
	{
		if(worker->setParams(params))
			return true;
	}
	else
	{
		rError("Incorrect parameters");
	}
	return false;
}

void SpecificMonitor::readConfig(RoboCompCommonBehavior::ParameterList &params )
{
	RoboCompCommonBehavior::Parameter aux;
	aux.editable = true;
	QStringList colours;
	colours << "red" << "blue";
	configGetString( "Limits","Force", aux.value, "");
	params["Force"] = aux;
	configGetString( "","Colour", aux.value, "blue", &colours);
	params["Colour"] = aux;
	if (not configGetString( "Owner", aux.value, "nobody"))
		params["Owner"] = aux;
}

bool SpecificMonitor::checkParams(RoboCompCommonBehavior::ParameterList l)
{
	return l.size() > 0;
}
"""

NEW_H = """
#ifndef SPECIFICWORKER_H
#define SPECIFICWORKER_H

#define HIBERNATION_ENABLED

#include <genericworker.h>

class SpecificWorker : public GenericWorker
{
Q_OBJECT
public:
	SpecificWorker(TuplePrx tprx, bool startup_check);
	~SpecificWorker();
	bool setParams(RoboCompCommonBehavior::ParameterList params);

	int Arm_move(RoboCompTypes::Path path, bool fast) override;
	RoboCompTypes::Side Arm_state(RoboCompTypes::Pose &pose, RoboCompTypes::Named &named);
	void Arm_breakDown();
	void Arm_betray();
	void Arm_block(float seconds);
	RoboCompTypes::Image Hand_grasp(RoboCompTypes::Image image);

public slots:
	void initialize();
	void compute();
	void emergency();
	void restore();
	int startup_check();
signals:
	void enough();
private:
	bool startup_check_flag;
	int limit = 0;
	int turns = 0, bad = 0;
	std::string owner;
};

#endif
"""

NEW = """
#include "specificworker.h"

SpecificWorker::SpecificWorker(TuplePrx tprx, bool startup_check) : GenericWorker(tprx)
{
	this->startup_check_flag = startup_check;
	if(this->startup_check_flag)
	{
		this->startup_check();
	}
	else
	{
		#ifdef HIBERNATION_ENABLED
			hibernationChecker.start(500);
		#endif
		states["Rest"] = std::make_unique<GRAFCETStep>("Rest", 20,
			std::bind(&SpecificWorker::restore, this), nullptr, [] { std::cout << "rested" << std::endl; });
		states["Compute"]->addTransition(this, SIGNAL(enough()), states["Rest"].get());
		states["Rest"]->addTransition(states["Rest"].get(), SIGNAL(entered()), states["Compute"].get());
		statemachine.addState(states["Rest"].get());

		statemachine.setChildMode(QState::ExclusiveStates);
		statemachine.start();
		auto error = statemachine.errorString();
		if (error.length() > 0){
			qWarning() << error;
			throw error;
		}
	}
}

SpecificWorker::~SpecificWorker()
{
	std::cout << "Destroying SpecificWorker" << std::endl;
}

bool SpecificWorker::setParams(RoboCompCommonBehavior::ParameterList params)
{
	limit = std::stoi(params.at("Limits.Force").value);
	owner = params["Owner"].value;
	return true;
}

void SpecificWorker::initialize()
{
	std::cout << "initialize worker" << std::endl;
	setPeriod(STATES::Compute, 20);
	setPeriod(STATES::Emergency, 10);
}

void SpecificWorker::compute()
{
	turns++;
	if (turns == 1)
		std::cout << "first turn, period " << getPeriod(STATES::Compute) << " limit " << limit << " of " << owner << std::endl;
	if (turns == 3)
		emit goToEmergency();
	if (turns == 5)
		emit enough();
	this->armevents_pubproxy->count(turns);
	if (turns % 7 == 0)
		throw std::domain_error("seven");
}

void SpecificWorker::emergency()
{
	if (++bad == 2)
	{
		std::cout << "emergency after turn " << turns << std::endl;
		emit goToRestore();
	}
}

void SpecificWorker::restore()
{
	std::cout << "restored" << std::endl;
}

int SpecificWorker::startup_check()
{
	std::cout << "Startup check" << std::endl;
	QTimer::singleShot(200, QCoreApplication::instance(), SLOT(quit()));
	return 0;
}

int SpecificWorker::Arm_move(RoboCompTypes::Path path, bool fast)
{
	hibernation = true;
	if (fast)
		throw RoboCompArm::Blocked{path.at(0), static_cast<float>(limit)};
	return path.size();
}

RoboCompTypes::Side SpecificWorker::Arm_state(RoboCompTypes::Pose &pose, RoboCompTypes::Named &named)
{
	pose = {static_cast<float>(turns), 8, RoboCompTypes::Side::left};
	named["home"] = pose;
	return RoboCompTypes::Side::right;
}

void SpecificWorker::Arm_breakDown()
{
	QMetaObject::invokeMethod(this, [this] { setPeriod(STATES::Compute, 500); }, Qt::QueuedConnection);
}

void SpecificWorker::Arm_betray()
{
	emit kill();
}

void SpecificWorker::Arm_block(float) {}

RoboCompTypes::Image SpecificWorker::Hand_grasp(RoboCompTypes::Image image)
{
	return {image.rbegin(), image.rend()};
}
"""

LATEST_H = """
#pragma once

#include <genericworker.h>

class SpecificWorker : public GenericWorker
{
Q_OBJECT
public:
	SpecificWorker(const ConfigLoader& configLoader, TuplePrx tprx, bool startup_check);
	void ArmEvents_moved(RoboCompTypes::Pose pose);
	void ArmEvents_count(int n);
public slots:
	void initialize();
	void compute();
	void emergency() {}
	void restore() {}
	int startup_check();
private:
	std::atomic_int counts{0};
	bool done = false;
};
"""

LATEST = """
#include "specificworker.h"

SpecificWorker::SpecificWorker(const ConfigLoader& configLoader, TuplePrx tprx, bool startup_check)
	: GenericWorker(configLoader, tprx)
{
	if (startup_check)
		this->startup_check();
}

void SpecificWorker::initialize()
{
	setPeriod(STATES::Compute, configLoader.get<int>("Period.Compute"));
	std::cout << "configured " << this->configLoader.get<int>("Period.Compute") << " "
		<< configLoader.get<double>("Limits.Force") + 1 << " " << configLoader.get<std::string>("Owner") << " "
		<< configLoader.get<bool>("Fast") << std::endl;
	for (const double gain : configLoader.get<std::vector<double>>("Gains"))
		std::cout << gain << " ";
	for (const auto& label : configLoader.get<std::vector<std::string>>("Labels"))
		std::cout << label << ";";
	std::cout << configLoader.get<unsigned>("Period.Compute") << std::endl;
	try { configLoader.get<std::vector<int>>("Gains"); }
	catch (const std::exception& e) { std::cout << e.what() << std::endl; }
	try { configLoader.get<int>("Nothing"); }
	catch (const std::exception& e) { std::cout << e.what() << std::endl; }
}

void SpecificWorker::compute()
{
	if (done or counts < 3)
		return;
	done = true;
	RoboCompTypes::Path path{{1, 2, RoboCompTypes::Side::left}, {7, 0, RoboCompTypes::Side::left}};
	std::cout << "move " << arm_proxy->move(path, false) << " " << arm2_proxy->move({path[0]}, false) << std::endl;
	RoboCompTypes::Pose pose;
	RoboCompTypes::Named named;
	auto side = arm_proxy->state(pose, named);
	std::cout << "state " << (side == RoboCompTypes::Side::right) << " " << pose.y << " " << named.begin()->first << std::endl;
	auto image = hand_proxy->grasp({'a', 'b', 'c'});
	std::cout << "grasp " << std::string(image.begin(), image.end()) << std::endl;
	try { arm_proxy->move(path, true); }
	catch (const RoboCompArm::Blocked& e) { std::cout << "blocked at " << e.where.x << " " << e.force << std::endl; }
	arm_proxy->breakDown();
	std::cout << "that is all" << std::endl;
}

void SpecificWorker::ArmEvents_moved(RoboCompTypes::Pose) {}

void SpecificWorker::ArmEvents_count(int)
{
	++counts;
}

int SpecificWorker::startup_check()
{
	QTimer::singleShot(200, QCoreApplication::instance(), SLOT(quit()));
	return 0;
}
"""

FACE_H = """
#ifndef SPECIFICWORKER_H
#define SPECIFICWORKER_H

#include <genericworker.h>

class SpecificWorker : public GenericWorker
{
Q_OBJECT
public:
	SpecificWorker(TuplePrx tprx, bool startup_check);
	bool setParams(RoboCompCommonBehavior::ParameterList) { return true; }
public slots:
	void compute();
	void initialize(int period);
	void clicked();
};

#endif
"""

FACE = """
#include "specificworker.h"

SpecificWorker::SpecificWorker(TuplePrx tprx, bool) : GenericWorker(tprx)
{
	connect(button, SIGNAL(clicked()), this, SLOT(clicked()));
}

void SpecificWorker::initialize(int period)
{
	timer.start(period);
}

void SpecificWorker::clicked()
{
	label->setText("clicked");
}

void SpecificWorker::compute()
{
	button->click();
	std::cout << label->text().toStdString() << " " << isVisible() << std::endl;
	close();
}
"""

_STALE = "#error this is outdated\n"

SOURCES = {
    "Window": {
        "src/specificworker.h": WINDOW_H, "src/specificworker.cpp": WINDOW,
        "src/mainUI.ui": FORM.format(base="QMainWindow"),
    },
    "Dialog": {"src/specificworker.cpp": DIALOG},
    "Old": {
        "src/specificworker.h": OLD_H, "src/specificworker.cpp": OLD, "src/main.cpp": _STALE,
        "src/genericworker.cpp": _STALE, "src/armI.cpp": _STALE, "src/genericmonitor.cpp": _STALE,
        "src/genericmonitor.h": f"#ifndef GENERICMONITOR_H\n#define GENERICMONITOR_H\n{_STALE}#endif\n",
        "src/specificmonitor.h": MONITOR_H, "src/specificmonitor.cpp": MONITOR,
        "src/genericworker.h": f"#ifndef GENERICWORKER_H\n#define GENERICWORKER_H\n{_STALE}#endif\n",
        "src/CMakeListsSpecific.txt": "set(SOURCES specificworker.cpp)\nset(LIBS ${LIBS} m)\n",
    },
    "New": {"src/specificworker.h": NEW_H, "src/specificworker.cpp": NEW},
    "Latest": {"src/specificworker.h": LATEST_H, "src/specificworker.cpp": LATEST},
    "Face": {
        "src/specificworker.h": FACE_H, "src/specificworker.cpp": FACE, "src/mainUI.ui": FORM.format(base="QWidget"),
    },
}  # fmt: skip
