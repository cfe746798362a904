"""A cluster with TLS needs a certificate: Dask itself would wait and print a traceback."""
import pytest

from rbx1_nav.batch.cluster import open_cluster
from rbx1_nav.config import ConfigError

dask = pytest.importorskip('dask')
pytest.importorskip('distributed')


@pytest.mark.parametrize('file', [None, '/none.pem'])
def test_no_certificate(file):
    with dask.config.set({'distributed.comm.tls.ca-file': file, 'distributed.comm.tls.client.cert': file}):
        with pytest.raises(ConfigError, match='and for tls:// a certificate'):
            with open_cluster('tls://127.0.0.1:1', None, None):
                pass
