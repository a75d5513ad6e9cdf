// Judges values with a component's generated accessors: one line of JSON in, one line of hexadecimal answers out.
#include "parameters.h"

#include "runtime/log.h"

#include <cmath>
#include <iostream>
#include <limits>

namespace runtime
{

// The run time's log needs Ice; nothing is logged here.
Log::Log(std::string name) : name_(std::move(name))
{
}

void Log::error(const std::string&) const
{
}

}

namespace
{

using runtime::Value;

struct Parser
{
    const std::string& text;
    std::size_t at = 0;

    Value value()
    {
        switch (text[at])
        {
        case '{':
            return map();
        case '[':
            return list();
        case '"':
            return string();
        case 't':
            at += 4;
            return true;
        case 'f':
            at += 5;
            return false;
        case 'n':
            at += 4;
            return {};
        default:
            return number();
        }
    }

    Value map()
    {
        Value::Map made;
        for (++at; text[at] != '}';)
        {
            at += text[at] == ',' ? 1 : 0;
            const auto key = string();
            ++at;
            made[key] = value();
        }
        ++at;
        return made;
    }

    Value list()
    {
        Value::List made;
        for (++at; text[at] != ']';)
        {
            at += text[at] == ',' ? 1 : 0;
            made.push_back(value());
        }
        ++at;
        return made;
    }

    /// Texts come in hexadecimal: no escapes.
    std::string string()
    {
        const auto end = text.find('"', at + 1);
        std::string made;
        for (++at; at < end; at += 2)
        {
            made += static_cast<char>(std::stoi(text.substr(at, 2), nullptr, 16));
        }
        ++at;
        return made;
    }

    Value number()
    {
        const auto end = std::min(text.find_first_of(",]}", at), text.size());
        const auto word = text.substr(at, end - at);
        at = end;
        const bool isWhole = word.find_first_not_of("-0123456789") == std::string::npos;
        const auto infinity = std::numeric_limits<double>::infinity();
        if (!isWhole)
        {
            return word == "NaN" ? std::nan("")
                : word == "Infinity"  ? infinity
                : word == "-Infinity" ? -infinity
                                      : std::strtod(word.c_str(), nullptr);
        }
        const auto exact = runtime::readWhole(word);
        if (exact.as<long long>() != nullptr)
        {
            return exact;
        }
        const double near = std::strtod(word.c_str(), nullptr);
        return near == -0x1p63 ? std::nextafter(near, -infinity) : near; // not the least number of 64 bits
    }
};

std::string hex(const std::string& text)
{
    std::string made;
    for (const unsigned char c : text)
    {
        made += "0123456789abcdef"[c >> 4];
        made += "0123456789abcdef"[c & 15];
    }
    return made;
}

/// What is wrong, or each plain value by its path.
void answer(const runtime::Kind& kind, const Value& raw, bool isText)
{
    runtime::Taking taking;
    taking.isText = isText;
    const auto value = kind.take(raw, {}, taking);
    std::string said = taking.problems.empty() ? "fits" : "no";
    for (const auto& problem : taking.problems)
    {
        said += " " + hex(problem.message);
    }
    if (taking.problems.empty())
    {
        for (const auto& [key, entry] : runtime::flat(kind, value, {}))
        {
            said += " " + hex(key) + "=" + hex(entry.text);
        }
    }
    std::cout << said << "\n";
}

}

/// `judge NAME JSON`: data for the member NAME. `put NAME JSON`: the same, as a component sets it. `read NAME JSON`:
/// properties for it. `constraints JSON`: all values.
int main()
{
    const auto table = parameters::table();
    std::string command;
    while (std::cin >> command)
    {
        std::string names;
        std::string text;
        if (command != "constraints")
        {
            std::cin >> names;
        }
        std::cin >> text;
        Parser parser{text};
        const auto value = parser.value();
        std::vector<runtime::Member> members;
        if (!names.empty())
        {
            members.push_back(*table.kind.member(names));
        }
        if (command == "constraints")
        {
            for (const auto& constraint : table.constraints)
            {
                std::cout << constraint.holds(value);
            }
            std::cout << "\n";
        }
        else if (command == "judge")
        {
            answer(runtime::group(members), Value::Map{{names, value}}, false);
        }
        else if (command == "put")
        {
            const auto kind = runtime::group(members);
            Value data = Value::Map{};
            runtime::put(kind, data, {names}, value);
            answer(kind, data, false);
        }
        else
        {
            runtime::Texts properties;
            for (const auto& [key, item] : *value.as<Value::Map>())
            {
                properties[key] = *item.as<std::string>();
            }
            const auto kind = runtime::group(members);
            answer(kind, runtime::Reader(properties, table.spellings).read(kind), true);
        }
    }
}
