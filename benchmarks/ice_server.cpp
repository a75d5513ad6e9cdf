// A small server of Ice: an object in each adapter of its configuration, which answers to ice_ping.
#include <Ice/Ice.h>

class Object : public Ice::Object {};

int main(int argc, char* argv[])
{
    Ice::CtrlCHandler ctrlC;
    Ice::InitializationData data;
    data.properties = Ice::createProperties();
    data.properties->load(argv[1]);
    const Ice::CommunicatorHolder holder(argc, argv, data);
    ctrlC.setCallback([&](int) { holder.communicator()->shutdown(); });
    for (const auto& entry : {std::make_pair("Answer", "answer"), std::make_pair("CommonBehavior", "commonbehavior")})
    {
        const auto adapter = holder.communicator()->createObjectAdapter(entry.first);
        adapter->add(std::make_shared<Object>(), Ice::stringToIdentity(entry.second));
        adapter->activate();
    }
    holder.communicator()->waitForShutdown();
}
