# The command kfmaps for an unprivileged user:
#   docker build -t kfmaps . && docker run --rm -v "$PWD:/work" --user "$(id -u):$(id -g)" kfmaps match a.ply b.ply
# tests/test_image.py carries out these steps without a builder.
FROM python:3.13-slim AS build
WORKDIR /build
COPY pyproject.toml constraints.txt README.md LICENSE ./
COPY src src
RUN python -m venv /opt/kfmaps && /opt/kfmaps/bin/pip install --no-cache-dir --constraint constraints.txt .

FROM python:3.13-slim
COPY --from=build /opt/kfmaps /opt/kfmaps
RUN useradd --create-home --uid 1000 kfmaps
# One thread a process; matplotlib's cache where every user may write.
ENV PATH=/opt/kfmaps/bin:$PATH OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 MPLCONFIGDIR=/tmp/matplotlib
USER kfmaps
WORKDIR /work
ENTRYPOINT ["kfmaps"]
CMD ["--help"]
