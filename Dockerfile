# An image with giveway and its compiled kernels:
#     docker build -t giveway . && docker run --rm -v "$PWD/results:/home/driver/results" giveway run encounter
# This file has not been built: no Docker was at hand. Its commands were run one by one in a new
# environment of Python with an empty home folder.
FROM python:3.11-slim AS build
COPY . /src
RUN python -m pip wheel --no-cache-dir --no-deps --wheel-dir /wheels /src

FROM python:3.11-slim
COPY .ci/requirements-run.txt /wheels/
COPY --from=build /wheels/*.whl /wheels/
RUN python -m pip install --no-cache-dir --require-hashes -r /wheels/requirements-run.txt \
    && python -m pip install --no-cache-dir --no-deps /wheels/*.whl
ENV NUMBA_CACHE_DIR=/opt/giveway-kernels
RUN giveway precompile --into /opt/giveway-kernels
RUN useradd --create-home driver
USER driver
WORKDIR /home/driver
ENTRYPOINT ["giveway"]
CMD ["doctor"]
