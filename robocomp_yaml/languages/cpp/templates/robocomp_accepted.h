// The signatures that the versions of RoboComp's own tool wrote or called, and that the generic part calls.
class SpecificWorker : public GenericWorker
{
public:
    SpecificWorker(MapPrx& mprx);
    SpecificWorker(MapPrx& mprx, bool startup_check);
    SpecificWorker(TuplePrx tprx);
    SpecificWorker(TuplePrx tprx, bool startup_check);
    SpecificWorker(const ConfigLoader& configLoader, TuplePrx tprx, bool startup_check);
    bool setParams(RoboCompCommonBehavior::ParameterList params);
    void initialize();
    void initialize(int period);
    void compute();
};
