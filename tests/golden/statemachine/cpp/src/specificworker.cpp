// This file is yours: rcyaml wrote it once, and will not touch it again.
#include "specificworker.h"

void SpecificWorker::initialize()
{
    log.info("initializing");
}

void SpecificWorker::compute()
{
}

void SpecificWorker::sm_closed()
{
    log.info("sm_closed() is still to be written");
}

void SpecificWorker::sm_opened()
{
    log.info("sm_opened() is still to be written");
}

void SpecificWorker::sm_still()
{
    log.info("sm_still() is still to be written");
}

void SpecificWorker::sm_moving()
{
    log.info("sm_moving() is still to be written");
}

void SpecificWorker::sm_gone()
{
    log.info("sm_gone() is still to be written");
}

bool SpecificWorker::pushed()
{
    log.info("pushed() is still to be written");
    return false;
}

void SpecificWorker::ring()
{
    log.info("ring() is still to be written");
}
