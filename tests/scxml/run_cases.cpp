// Runs C++'s tables: prints what each machine entered and logged, a case a line.
#include "cases.h"
#include "machine/sessions.h"

#include <chrono>
#include <iostream>
#include <string>

namespace
{

/// Keeps the states that were entered, and what was logged; cases have neither guards nor actions.
class Host : public machine::Host
{
public:
    bool guard(const std::string& name) override
    {
        throw machine::Failure(name);
    }

    void act(const std::string& name) override
    {
        throw machine::Failure(name);
    }

    void entered(const std::string& state) override
    {
        entered_ += (entered_.empty() ? "" : ",") + state;
    }

    void left(const std::string&) override
    {
    }

    void log(const std::string& label, const std::string& value) override
    {
        logged_ += (logged_.empty() ? "" : ",") + label + " " + value;
    }

    void warn(const std::string&) override
    {
    }

    std::string entered_;
    std::string logged_;
};

std::string run(const machine::Machine& tables)
{
    machine::TimePoint now;
    const auto longest = now + std::chrono::minutes(1); // no case needs so much
    Host host;
    machine::Sessions sessions(host, [&now] { return now; });
    const auto session = sessions.open(tables);
    session->interpreter.start();
    sessions.run();
    for (auto due = sessions.nextDue(); session->interpreter.isRunning && due && *due < longest; due = sessions.nextDue())
    {
        now = *due;
        sessions.run();
    }
    return host.entered_ + "\t" + host.logged_;
}

}

int main()
{
    for (const auto& [name, tables] : machine::cases())
    {
        std::cout << name << '\t' << run(tables) << '\n';
    }
}
