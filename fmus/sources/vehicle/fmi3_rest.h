/* FMI 3.0: what does not differ between our models; the end of fmi3.c. */

/* ---- saved states ---- */

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *FMUState) {
    return instance == NULL ? fmi3Error : (fmi3Status)instance_save(instance, (Snapshot **)FMUState);
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState FMUState) {
    return instance == NULL ? fmi3Error : (fmi3Status)instance_restore(instance, FMUState);
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *FMUState) {
    if (FMUState == NULL) return fmi3OK;
    free(*FMUState);
    *FMUState = NULL;
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState FMUState, size_t *size) {
    *size = snapshot_size();
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState FMUState, fmi3Byte serializedState[], size_t size) {
    return instance == NULL ? fmi3Error : (fmi3Status)snapshot_serialize(instance, FMUState, serializedState, size);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte serializedState[], size_t size,
                                   fmi3FMUState *FMUState) {
    if (instance == NULL) return fmi3Error;
    return (fmi3Status)snapshot_deserialize(instance, serializedState, size, (Snapshot **)FMUState);
}

/* ---- what every FMU has to export but this one does not offer ---- */

#define UNSUPPORTED(NAME, ...) \
    fmi3Status NAME(fmi3Instance instance, __VA_ARGS__) { return unsupported(instance, #NAME); }
#define UNSUPPORTED_PLAIN(NAME) \
    fmi3Status NAME(fmi3Instance instance) { return unsupported(instance, #NAME); }
#define REFERENCES(NAME) const fmi3ValueReference NAME[], size_t n##NAME

UNSUPPORTED_PLAIN(fmi3EnterEventMode)
UNSUPPORTED_PLAIN(fmi3EnterStepMode)
UNSUPPORTED_PLAIN(fmi3EnterContinuousTimeMode)
UNSUPPORTED_PLAIN(fmi3EvaluateDiscreteStates)
UNSUPPORTED(fmi3UpdateDiscreteStates, fmi3Boolean *discreteStatesNeedUpdate, fmi3Boolean *terminateSimulation,
            fmi3Boolean *nominalsOfContinuousStatesChanged, fmi3Boolean *valuesOfContinuousStatesChanged,
            fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime)

UNSUPPORTED(fmi3GetBinary, REFERENCES(valueReferences), size_t valueSizes[], fmi3Binary values[], size_t nValues)
UNSUPPORTED(fmi3SetBinary, REFERENCES(valueReferences), const size_t valueSizes[], const fmi3Binary values[], size_t nValues)
UNSUPPORTED(fmi3GetClock, REFERENCES(valueReferences), fmi3Clock values[])
UNSUPPORTED(fmi3SetClock, REFERENCES(valueReferences), const fmi3Clock values[])
UNSUPPORTED(fmi3GetIntervalDecimal, REFERENCES(valueReferences), fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
UNSUPPORTED(fmi3GetIntervalFraction, REFERENCES(valueReferences), fmi3UInt64 counters[], fmi3UInt64 resolutions[],
            fmi3IntervalQualifier qualifiers[])
UNSUPPORTED(fmi3GetShiftDecimal, REFERENCES(valueReferences), fmi3Float64 shifts[])
UNSUPPORTED(fmi3GetShiftFraction, REFERENCES(valueReferences), fmi3UInt64 counters[], fmi3UInt64 resolutions[])
UNSUPPORTED(fmi3SetIntervalDecimal, REFERENCES(valueReferences), const fmi3Float64 intervals[])
UNSUPPORTED(fmi3SetIntervalFraction, REFERENCES(valueReferences), const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
UNSUPPORTED(fmi3SetShiftDecimal, REFERENCES(valueReferences), const fmi3Float64 shifts[])
UNSUPPORTED(fmi3SetShiftFraction, REFERENCES(valueReferences), const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])

UNSUPPORTED(fmi3GetNumberOfVariableDependencies, fmi3ValueReference valueReference, size_t *nDependencies)
UNSUPPORTED(fmi3GetVariableDependencies, fmi3ValueReference dependent, size_t elementIndicesOfDependent[],
            fmi3ValueReference independents[], size_t elementIndicesOfIndependents[], fmi3DependencyKind dependencyKinds[],
            size_t nDependencies)
UNSUPPORTED(fmi3GetDirectionalDerivative, REFERENCES(unknowns), REFERENCES(knowns), const fmi3Float64 seed[], size_t nSeed,
            fmi3Float64 sensitivity[], size_t nSensitivity)
UNSUPPORTED(fmi3GetAdjointDerivative, REFERENCES(unknowns), REFERENCES(knowns), const fmi3Float64 seed[], size_t nSeed,
            fmi3Float64 sensitivity[], size_t nSensitivity)
UNSUPPORTED(fmi3GetOutputDerivatives, REFERENCES(valueReferences), const fmi3Int32 orders[], fmi3Float64 values[],
            size_t nValues)

UNSUPPORTED(fmi3CompletedIntegratorStep, fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *enterEventMode,
            fmi3Boolean *terminateSimulation)
UNSUPPORTED(fmi3SetTime, fmi3Float64 time)
UNSUPPORTED(fmi3SetContinuousStates, const fmi3Float64 continuousStates[], size_t nContinuousStates)
UNSUPPORTED(fmi3GetContinuousStateDerivatives, fmi3Float64 derivatives[], size_t nContinuousStates)
UNSUPPORTED(fmi3GetEventIndicators, fmi3Float64 eventIndicators[], size_t nEventIndicators)
UNSUPPORTED(fmi3GetContinuousStates, fmi3Float64 continuousStates[], size_t nContinuousStates)
UNSUPPORTED(fmi3GetNominalsOfContinuousStates, fmi3Float64 nominals[], size_t nContinuousStates)
UNSUPPORTED(fmi3GetNumberOfEventIndicators, size_t *nEventIndicators)
UNSUPPORTED(fmi3GetNumberOfContinuousStates, size_t *nContinuousStates)
UNSUPPORTED(fmi3ActivateModelPartition, fmi3ValueReference clockReference, fmi3Float64 activationTime)
